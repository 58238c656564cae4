#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/extras/ros/mcap/byte_file.h"
#include "core/extras/ros/mcap/mcap_records.h"

namespace railcast::mcap {

/// A record of a file, of which the content has not been read.
struct RecordPlace {
  McapOpcode opcode{};
  std::uint64_t offset{};  ///< Offset of its opcode in the file.
  std::uint64_t size{};    ///< Size of its content.

  [[nodiscard]] std::uint64_t end() const { return offset + kRecordHead_bytes + size; }
};

/// "bag.mcap: record at 25: ", for messages.
[[nodiscard]] std::string PlaceOf(const ByteFile& file, std::uint64_t offset);

/// Returns the record at a place of the file; nothing if the file ends within it.
[[nodiscard]] std::optional<RecordPlace> RecordAt(const ByteFile& file, std::uint64_t offset);

/// Returns the content of a record.
/// @throws InputError "file: record at N: rule (got value)" if it is larger than
///   kMaxUncompressed_bytes.
[[nodiscard]] Bytes ContentOf(const ByteFile& file, const RecordPlace& record);

/// Returns the records in a chunk, of which `content` is the content.
/// @param storage Holds them if they were compressed.
/// @throws InputError "rule (got value)" if they are damaged.
[[nodiscard]] ByteSpan RecordsOfChunk(ByteSpan content, Bytes& storage);

/// Goes through the records of a file from its begin to its end, or to the last whole one where the
/// file was cut off.
class RecordScan {
 public:
  /// @param file Must outlive the scan.
  /// @throws InputError "file: must begin as an MCAP file" if it does not.
  explicit RecordScan(const ByteFile& file);

  [[nodiscard]] std::optional<RecordPlace> Next();

  /// Whether Next() has met the end of a complete file.
  [[nodiscard]] bool is_complete() const { return is_complete_; }

 private:
  const ByteFile& file_;
  std::uint64_t place_{};
  bool is_footer_read_ = false;
  bool is_complete_ = false;
};

/// Whether the file begins as an MCAP file.
[[nodiscard]] bool BeginsAsMcap(const ByteFile& file);

}  // namespace railcast::mcap
