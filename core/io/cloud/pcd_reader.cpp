#include "core/io/cloud/pcd_reader.h"

#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <type_traits>

#include "core/base/error.h"
#include "core/base/text.h"

// The header of liblzf is one of C.
extern "C" {
#include <lzf.h>
}

namespace railcast {
namespace {

constexpr std::uint64_t kMaxCloudBytes = std::numeric_limits<std::uint32_t>::max();

// Collects the lines of one header; errors name the file.
class HeaderReader {
 public:
  HeaderReader(const std::string& file, std::string_view bytes) : file_(file), rest_(bytes) {
    const std::size_t size = bytes.size();
    while (const auto line = TakeLine(rest_)) {
      const auto words = Words(*line);
      if (words.empty() || words[0].starts_with('#')) continue;
      const std::string key(words[0] == "COLUMNS" ? "FIELDS" : words[0]);
      if (key != "VERSION" && key != "FIELDS" && key != "SIZE" && key != "TYPE" && key != "COUNT" &&
          key != "WIDTH" && key != "HEIGHT" && key != "VIEWPOINT" && key != "POINTS" &&
          key != "DATA") {
        Fail("is no PCD file: a header line begins with none of its keys");
      }
      if (!lines_.emplace(key, std::vector(words.begin() + 1, words.end())).second) {
        Fail(key + ": comes twice");
      }
      if (key != "DATA") continue;
      data_begin_ = size - rest_.size();
      return;
    }
    Fail("is no PCD file: its header has no DATA line");
  }

  [[noreturn]] void Fail(const std::string& rule) const { throw InputError(file_ + ": " + rule); }

  [[nodiscard]] bool Has(const std::string& key) const { return lines_.contains(key); }

  [[nodiscard]] const std::vector<std::string_view>& Entries(const std::string& key) const {
    const auto line = lines_.find(key);
    if (line == lines_.end()) Fail(key + ": missing");
    return line->second;
  }

  [[nodiscard]] std::uint64_t Number(const std::string& key) const {
    const auto& words = Entries(key);
    if (words.size() != 1) Fail(key + ": must be one number");
    return Number(key, words[0]);
  }

  [[nodiscard]] std::uint64_t Number(const std::string& key, std::string_view word) const {
    const auto number = ParseNumber<std::uint64_t>(word);
    if (!number || *number > kMaxCloudBytes) {
      Fail(key + ": must be a whole number below 2^32 (got " + ShownText(word) + ")");
    }
    return *number;
  }

  [[nodiscard]] std::size_t data_begin() const { return data_begin_; }

 private:
  const std::string& file_;
  std::string_view rest_;
  std::map<std::string, std::vector<std::string_view>> lines_;
  std::size_t data_begin_{};
};

std::vector<PcdField> ReadFields(const HeaderReader& reader) {
  const auto& names = reader.Entries("FIELDS");
  if (names.empty()) reader.Fail("FIELDS: must name at least one field");
  for (const std::string key : {"SIZE", "TYPE", "COUNT"}) {
    if (key == "COUNT" && !reader.Has(key)) continue;
    const std::size_t count = reader.Entries(key).size();
    if (count != names.size()) {
      reader.Fail(key + ": must have " + std::to_string(names.size()) +
                  " entries, one for each of FIELDS (got " + std::to_string(count) + ")");
    }
  }
  std::vector<PcdField> fields;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string_view type = reader.Entries("TYPE")[i];
    const std::uint64_t size = reader.Number("SIZE", reader.Entries("SIZE")[i]);
    const std::uint64_t count =
        reader.Has("COUNT") ? reader.Number("COUNT", reader.Entries("COUNT")[i]) : 1;
    if (type != "I" && type != "U" && type != "F") {
      reader.Fail("TYPE: must be I, U or F (got " + ShownText(type) + ")");
    }
    const bool is_size =
        type == "F" ? size == 4 || size == 8 : size == 1 || size == 2 || size == 4 || size == 8;
    if (!is_size) {
      reader.Fail("SIZE: no " + std::string(type) + " has " + std::to_string(size) + " bytes");
    }
    if (count == 0) reader.Fail("COUNT: must be > 0 (got 0)");
    fields.push_back({std::string(names[i]), size, type[0], count});
  }
  return fields;
}

bool IsValue(std::string_view word, const PcdField& field) {
  if (field.type == 'F') return ParseNumber<double>(word).has_value();
  const std::uint64_t bits = 8 * field.size;
  if (field.type == 'U') {
    const auto value = ParseNumber<std::uint64_t>(word);
    return value && (bits == 64 || *value >> bits == 0);
  }
  const auto value = ParseNumber<std::int64_t>(word);
  const std::int64_t limit = std::numeric_limits<std::int64_t>::max() >> (64U - bits);
  return value && *value <= limit && *value >= -limit - 1;
}

void CheckAsciiLine(const HeaderReader& reader, const PcdHeader& header, std::string_view line) {
  const auto words = Words(line);
  std::size_t word = 0;
  for (const PcdField& field : header.fields) {
    for (std::uint64_t i = 0; i < field.count; ++i, ++word) {
      if (word >= words.size()) reader.Fail("a point has fewer values than FIELDS asks for");
      if (!IsValue(words[word], field)) {
        reader.Fail(ShownText(field.name) + ": no value of its type (got " +
                    ShownText(words[word]) + ")");
      }
    }
  }
  if (word != words.size()) reader.Fail("a point has more values than FIELDS asks for");
}

void CheckAscii(const HeaderReader& reader, const PcdHeader& header, std::string_view data) {
  std::uint64_t num_lines = 0;
  while (const auto line = TakeLine(data)) {
    if (line->empty()) continue;
    CheckAsciiLine(reader, header, *line);
    ++num_lines;
  }
  if (num_lines != header.points) {
    reader.Fail("POINTS: " + std::to_string(header.points) + " need as many lines, the file has " +
                std::to_string(num_lines));
  }
}

/// Whether data have this size, or end in the zeros that PCL's writer of PCLPointCloud2 leaves
/// behind them: up to a page.
bool HasSize(std::string_view data, std::uint64_t expected) {
  constexpr std::size_t kMostPadding = 65536;  // The largest page that Linux has, on ARM.
  return data.size() >= expected && data.size() - expected <= kMostPadding &&
         data.find_first_not_of('\0', expected) == std::string_view::npos;
}

void CheckBinary(const HeaderReader& reader, const PcdHeader& header, std::string_view data) {
  const std::uint64_t expected = header.points * header.PointStep();
  if (!HasSize(data, expected)) {
    reader.Fail("POINTS: " + std::to_string(header.points) + " need " + std::to_string(expected) +
                " bytes, the file has " + std::to_string(data.size()));
  }
}

/// Decompresses the points and checks their size.
/// @param scratch Receives the decompressed points.
void CheckCompressed(const HeaderReader& reader,
                     const PcdHeader& header,
                     std::string_view data,
                     std::string& scratch) {
  std::uint32_t packed = 0;
  std::uint32_t plain = 0;
  if (data.size() < sizeof packed + sizeof plain)
    reader.Fail("DATA: the compressed sizes are missing");
  std::memcpy(&packed, data.data(), sizeof packed);
  std::memcpy(&plain, data.data() + sizeof packed, sizeof plain);
  const std::size_t rest = data.size() - sizeof packed - sizeof plain;
  if (!HasSize(data.substr(sizeof packed + sizeof plain), packed)) {
    reader.Fail("DATA: " + std::to_string(packed) + " compressed bytes announced, the file has " +
                std::to_string(rest));
  }
  const std::uint64_t expected = header.points * header.PointStep();
  if (plain != expected) {
    reader.Fail("POINTS: " + std::to_string(header.points) + " need " + std::to_string(expected) +
                " bytes, the compressed data hold " + std::to_string(plain));
  }
  // Three bytes of LZF expand to at most 264, so a larger claim is false and must not be given
  // memory.
  constexpr std::uint32_t kMaxRatio = 88;
  if (plain / kMaxRatio > packed) reader.Fail("DATA: the compressed data are damaged");
  scratch.resize(plain);
  const char* begin = data.data() + sizeof packed + sizeof plain;
  if (lzf_decompress(begin, packed, scratch.data(), plain) != plain) {
    reader.Fail("DATA: the compressed data are damaged");
  }
}

}  // namespace

NumberType PcdField::number_type() const {
  if (type == 'F') return size == 4 ? NumberType::kFloat : NumberType::kDouble;
  const bool is_signed = type == 'I';
  switch (size) {
    case 1:
      return is_signed ? NumberType::kInt8 : NumberType::kUint8;
    case 2:
      return is_signed ? NumberType::kInt16 : NumberType::kUint16;
    case 4:
      return is_signed ? NumberType::kInt32 : NumberType::kUint32;
    default:
      return is_signed ? NumberType::kInt64 : NumberType::kUint64;
  }
}

std::uint64_t PcdHeader::PointStep() const {
  std::uint64_t step = 0;
  for (const PcdField& field : fields) step += field.size * field.count;
  return step;
}

PcdHeader CheckPcd(const std::string& file, std::string_view bytes, std::string* plain) {
  const HeaderReader reader(file, bytes);
  PcdHeader header;
  header.fields = ReadFields(reader);
  header.width = reader.Number("WIDTH");
  header.height = reader.Number("HEIGHT");
  header.points = reader.Has("POINTS") ? reader.Number("POINTS") : header.width * header.height;
  header.data_begin = reader.data_begin();
  const auto& data = reader.Entries("DATA");
  if (data.size() == 1) header.data = data[0];
  if (reader.Has("VIEWPOINT") && reader.Entries("VIEWPOINT").size() != 7) {
    reader.Fail("VIEWPOINT: must have 7 numbers");
  }
  // Width and height are below 2^32 each, so their product cannot wrap.
  if (header.points != header.width * header.height || header.points == 0) {
    reader.Fail("POINTS: must be WIDTH x HEIGHT and > 0 (got " + std::to_string(header.points) +
                " for " + std::to_string(header.width) + " x " + std::to_string(header.height) +
                ")");
  }
  if (header.points > kMaxCloudBytes || header.PointStep() > kMaxCloudBytes / header.points) {
    reader.Fail("POINTS: " + std::to_string(header.points) + " points of " +
                std::to_string(header.PointStep()) + " bytes are 4 GiB or more");
  }
  const std::string_view points = bytes.substr(header.data_begin);
  if (header.data == "ascii") {
    CheckAscii(reader, header, points);
  } else if (header.data == "binary") {
    CheckBinary(reader, header, points);
  } else if (header.data == "binary_compressed") {
    std::string scratch;
    CheckCompressed(reader, header, points, plain != nullptr ? *plain : scratch);
  } else {
    reader.Fail("DATA: must be ascii, binary or binary_compressed");
  }
  return header;
}

std::string PackAscii(std::string_view text, const PcdHeader& header) {
  std::string packed(header.points * header.PointStep(), '\0');
  char* place = packed.data();
  while (const auto line = TakeLine(text)) {
    const auto words = Words(*line);
    std::size_t word = 0;
    if (words.empty()) continue;
    for (const PcdField& field : header.fields) {
      VisitNumberType(field.number_type(), [&](auto zero) {
        for (std::uint64_t i = 0; i < field.count; ++i, place += sizeof zero) {
          using Value = decltype(zero);
          // As in CheckPcd, a number too large for a float becomes infinite.
          using Parsed = std::conditional_t<std::is_floating_point_v<Value>, double, Value>;
          const auto value = static_cast<Value>(ParseNumber<Parsed>(words[word++]).value_or(0));
          std::memcpy(place, &value, sizeof value);
        }
      });
    }
  }
  return packed;
}

}  // namespace railcast
