#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/ros/mcap/mcap_records.h"
#include "core/extras/ros/messages/named_fields.h"

namespace railcast::mcap {

/// CRC-32 as of zlib, of `bytes` behind what has the CRC `before`.
[[nodiscard]] std::uint32_t Crc32(ByteSpan bytes, std::uint32_t before = 0);

/// Appends fields to a record.
class FieldWriter {
 public:
  explicit FieldWriter(Bytes& out) : out_(&out) {}

  template <std::unsigned_integral Number>
  void operator()(const char*, Number number) {
    // Little-endian, as every machine that this program is built for.
    Append({reinterpret_cast<const std::byte*>(&number), sizeof number});
  }
  void operator()(const char* name, const std::string& text) {
    (*this)(name, static_cast<std::uint32_t>(text.size()));
    Append(std::as_bytes(std::span(text)));
  }
  void operator()(const char* name, const CountedBytes& counted) {
    (*this)(name, std::uint64_t{counted.bytes.size()});
    Append(counted.bytes);
  }
  void operator()(const char*, ByteSpan rest) { Append(rest); }
  template <typename Key, typename Value>
  void operator()(const char* name, const std::map<Key, Value>& map) {
    AppendPairs(name, map);
  }
  template <typename First, typename Second>
  void operator()(const char* name, const std::vector<std::pair<First, Second>>& pairs) {
    AppendPairs(name, pairs);
  }

 private:
  void Append(ByteSpan bytes) { out_->insert(out_->end(), bytes.begin(), bytes.end()); }

  template <typename Pairs>
  void AppendPairs(const char* name, const Pairs& pairs) {
    const std::size_t start = out_->size();
    (*this)(name, std::uint32_t{0});
    for (const auto& [first, second] : pairs) {
      (*this)(name, first);
      (*this)(name, second);
    }
    const auto size = static_cast<std::uint32_t>(out_->size() - start - sizeof(std::uint32_t));
    std::memcpy(out_->data() + start, &size, sizeof size);
  }

  Bytes* out_;
};

/// Takes fields off the content of a record. What follows the last field is left unread, as the
/// specification asks.
class FieldReader {
 public:
  explicit FieldReader(ByteSpan content) : rest_(content) {}

  template <std::unsigned_integral Number>
  void operator()(const char* name, Number& number) {
    std::memcpy(&number, Take(name, sizeof number).data(), sizeof number);
  }
  void operator()(const char* name, std::string& text) {
    const ByteSpan bytes = TakeCounted<std::uint32_t>(name);
    text.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  void operator()(const char* name, CountedBytes& counted) {
    counted.bytes = TakeCounted<std::uint64_t>(name);
  }
  void operator()(const char*, ByteSpan& rest) { rest = std::exchange(rest_, {}); }
  template <typename Key, typename Value>
  void operator()(const char* name, std::map<Key, Value>& map) {
    ReadPairs<Key, Value>(name, [&](Key key, Value value) {
      map.insert_or_assign(std::move(key), std::move(value));
    });
  }
  template <typename First, typename Second>
  void operator()(const char* name, std::vector<std::pair<First, Second>>& pairs) {
    ReadPairs<First, Second>(
        name, [&](First first, Second second) { pairs.emplace_back(first, second); });
  }

  [[nodiscard]] std::size_t num_left() const { return rest_.size(); }

 private:
  ByteSpan Take(const char* name, std::uint64_t size) {
    if (size > rest_.size()) {
      throw InputError(std::string(name) + ": must lie within its record (got " + NumberText(size) +
                       " bytes where " + NumberText(rest_.size()) + " are left)");
    }
    const ByteSpan taken = rest_.first(size);
    rest_ = rest_.subspan(size);
    return taken;
  }

  template <typename Count>
  ByteSpan TakeCounted(const char* name) {
    Count count{};
    (*this)(name, count);
    return Take(name, count);
  }

  template <typename First, typename Second, typename Add>
  void ReadPairs(const char* name, const Add& add) {
    FieldReader pairs(TakeCounted<std::uint32_t>(name));
    while (pairs.num_left() > 0) {
      First first{};
      Second second{};
      pairs(name, first);
      pairs(name, second);
      add(std::move(first), std::move(second));
    }
  }

  ByteSpan rest_;
};

/// Appends a whole record: opcode, length, content.
template <typename Record>
void AppendRecord(const Record& record, Bytes& out) {
  const std::size_t start = out.size();
  out.push_back(static_cast<std::byte>(Record::kOpcode));
  FieldWriter write(out);
  write("length", std::uint64_t{0});
  VisitFields(record, write);
  const std::uint64_t size = out.size() - start - kRecordHead_bytes;
  std::memcpy(out.data() + start + 1, &size, sizeof size);
}

/// Reads the content of a record, whose members of type ByteSpan refer to `content`.
/// @throws InputError "field: rule (got value)" if the content is too short.
template <typename Record>
[[nodiscard]] Record ReadRecord(ByteSpan content) {
  Record record;
  VisitFields(record, FieldReader(content));
  return record;
}

/// A record inside a chunk or a summary.
struct RecordView {
  McapOpcode opcode{};
  std::size_t offset{};  ///< Offset of its opcode, from the begin of the bytes.
  ByteSpan content;
};

/// Goes through the records in some bytes.
class RecordCursor {
 public:
  explicit RecordCursor(ByteSpan bytes) : bytes_(bytes) {}

  /// Returns the next record, or nothing at the end.
  /// @throws InputError "record at N: rule" if the bytes end within it.
  [[nodiscard]] std::optional<RecordView> Next();

 private:
  ByteSpan bytes_;
  std::size_t place_{};
};

}  // namespace railcast::mcap
