#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// The records of MCAP files, with the names of the specification
/// (https://mcap.dev/spec, version 0). The members of each struct are the fields, in the order of
/// the file, and `kFields` names them: writer, reader and tests take them from there.
namespace railcast::mcap {

using Bytes = std::vector<std::byte>;
using ByteSpan = std::span<const std::byte>;

/// Where a message stands in a file.
struct MessagePlace {
  std::uint64_t record{};    ///< Offset of the record of its chunk, or of its own.
  std::uint64_t in_chunk{};  ///< Offset of its record in the uncompressed chunk.

  auto operator<=>(const MessagePlace&) const = default;
};

/// Begins and ends every file.
inline constexpr std::array<std::byte, 8> kMagic = {std::byte{0x89}, std::byte{'M'}, std::byte{'C'},
                                                    std::byte{'A'},  std::byte{'P'}, std::byte{'0'},
                                                    std::byte{'\r'}, std::byte{'\n'}};

enum class McapOpcode : std::uint8_t {
  kHeader = 1,
  kFooter,
  kSchema,
  kChannel,
  kMessage,
  kChunk,
  kMessageIndex,
  kChunkIndex,
  kAttachment,
  kAttachmentIndex,
  kStatistics,
  kMetadata,
  kMetadataIndex,
  kSummaryOffset,
  kDataEnd
};

/// Size of a record's opcode and length.
inline constexpr std::size_t kRecordHead_bytes = 9;

/// Bytes behind their number, a uint64. A ByteSpan by itself fills the rest of its record.
struct CountedBytes {
  ByteSpan bytes;
};

struct McapHeader {
  static constexpr McapOpcode kOpcode = McapOpcode::kHeader;
  static constexpr std::array kFields = {"profile", "library"};
  std::string profile;
  std::string library;
};

struct McapFooter {
  static constexpr McapOpcode kOpcode = McapOpcode::kFooter;
  static constexpr std::array kFields = {"summary_start", "summary_offset_start", "summary_crc"};
  std::uint64_t summary_start{};         ///< 0: there is no summary.
  std::uint64_t summary_offset_start{};  ///< 0: there are no summary offsets.
  std::uint32_t summary_crc{};           ///< From the summary's start to here; 0 = not available.
};

struct McapSchema {
  static constexpr McapOpcode kOpcode = McapOpcode::kSchema;
  static constexpr std::array kFields = {"id", "name", "encoding", "data"};
  std::uint16_t id{};  ///< Not 0.
  std::string name;
  std::string encoding;  ///< "ros2msg"
  std::string data;

  bool operator==(const McapSchema&) const = default;
};

struct McapChannel {
  static constexpr McapOpcode kOpcode = McapOpcode::kChannel;
  static constexpr std::array kFields = {"id", "schema_id", "topic", "message_encoding",
                                         "metadata"};
  std::uint16_t id{};
  std::uint16_t schema_id{};  ///< 0: none.
  std::string topic;
  std::string message_encoding;  ///< "cdr"
  std::map<std::string, std::string> metadata;

  bool operator==(const McapChannel&) const = default;
};

struct McapMessage {
  static constexpr McapOpcode kOpcode = McapOpcode::kMessage;
  static constexpr std::array kFields = {"channel_id", "sequence", "log_time", "publish_time",
                                         "data"};
  std::uint16_t channel_id{};
  std::uint32_t sequence{};
  std::uint64_t log_time{};  ///< In ns, as all times of these records.
  std::uint64_t publish_time{};
  ByteSpan data;
};

/// A batch of schemas, channels and messages, compressed together.
struct McapChunk {
  static constexpr McapOpcode kOpcode = McapOpcode::kChunk;
  static constexpr std::array kFields = {"message_start_time", "message_end_time",
                                         "uncompressed_size",  "uncompressed_crc",
                                         "compression",        "records"};
  std::uint64_t message_start_time{};  ///< 0 without messages.
  std::uint64_t message_end_time{};
  std::uint64_t uncompressed_size{};
  std::uint32_t uncompressed_crc{};  ///< 0 = not available.
  std::string compression;           ///< "", "lz4" or "zstd"
  CountedBytes records;
};

/// Where in the chunk before it the messages of a channel are: log time and offset of each.
struct McapMessageIndex {
  static constexpr McapOpcode kOpcode = McapOpcode::kMessageIndex;
  static constexpr std::array kFields = {"channel_id", "records"};
  std::uint16_t channel_id{};
  std::vector<std::pair<std::uint64_t, std::uint64_t>> records;
};

struct McapChunkIndex {
  static constexpr McapOpcode kOpcode = McapOpcode::kChunkIndex;
  static constexpr std::array kFields = {
      "message_start_time", "message_end_time",      "chunk_start_offset",
      "chunk_length",       "message_index_offsets", "message_index_length",
      "compression",        "compressed_size",       "uncompressed_size"};
  std::uint64_t message_start_time{};
  std::uint64_t message_end_time{};
  std::uint64_t chunk_start_offset{};
  std::uint64_t chunk_length{};  ///< Length of the whole record.
  std::map<std::uint16_t, std::uint64_t> message_index_offsets;
  std::uint64_t message_index_length{};
  std::string compression;
  std::uint64_t compressed_size{};
  std::uint64_t uncompressed_size{};
};

/// A file inside the file.
struct McapAttachment {
  static constexpr McapOpcode kOpcode = McapOpcode::kAttachment;
  static constexpr std::array kFields = {"log_time",   "create_time", "name",
                                         "media_type", "data",        "crc"};
  std::uint64_t log_time{};
  std::uint64_t create_time{};
  std::string name;
  std::string media_type;
  CountedBytes data;
  std::uint32_t crc{};  ///< CRC of the fields before it; 0 = not available.
};

struct McapAttachmentIndex {
  static constexpr McapOpcode kOpcode = McapOpcode::kAttachmentIndex;
  static constexpr std::array kFields = {"offset",    "length", "log_time",  "create_time",
                                         "data_size", "name",   "media_type"};
  std::uint64_t offset{};
  std::uint64_t length{};  ///< Length of the whole record.
  std::uint64_t log_time{};
  std::uint64_t create_time{};
  std::uint64_t data_size{};
  std::string name;
  std::string media_type;
};

struct McapStatistics {
  static constexpr McapOpcode kOpcode = McapOpcode::kStatistics;
  static constexpr std::array kFields = {
      "message_count",      "schema_count",     "channel_count",
      "attachment_count",   "metadata_count",   "chunk_count",
      "message_start_time", "message_end_time", "channel_message_counts"};
  std::uint64_t message_count{};
  std::uint16_t schema_count{};
  std::uint32_t channel_count{};
  std::uint32_t attachment_count{};
  std::uint32_t metadata_count{};
  std::uint32_t chunk_count{};
  std::uint64_t message_start_time{};
  std::uint64_t message_end_time{};
  std::map<std::uint16_t, std::uint64_t> channel_message_counts;
};

struct McapMetadata {
  static constexpr McapOpcode kOpcode = McapOpcode::kMetadata;
  static constexpr std::array kFields = {"name", "metadata"};
  std::string name;
  std::map<std::string, std::string> metadata;
};

struct McapMetadataIndex {
  static constexpr McapOpcode kOpcode = McapOpcode::kMetadataIndex;
  static constexpr std::array kFields = {"offset", "length", "name"};
  std::uint64_t offset{};
  std::uint64_t length{};
  std::string name;
};

/// Where in the summary the records of an opcode are.
struct McapSummaryOffset {
  static constexpr McapOpcode kOpcode = McapOpcode::kSummaryOffset;
  static constexpr std::array kFields = {"group_opcode", "group_start", "group_length"};
  std::uint8_t group_opcode{};
  std::uint64_t group_start{};
  std::uint64_t group_length{};
};

struct McapDataEnd {
  static constexpr McapOpcode kOpcode = McapOpcode::kDataEnd;
  static constexpr std::array kFields = {"data_section_crc"};
  std::uint32_t data_section_crc{};  ///< CRC of the file up to this record; 0 = not available.
};

}  // namespace railcast::mcap
