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
/// (https://mcap.dev/spec, version 0). Each struct describes its fields once, in the order of the
/// file, by Fields(): writer, reader and tests take them from there.
namespace railcast::mcap {

using Bytes = std::vector<std::byte>;
using ByteSpan = std::span<const std::byte>;

/// Where a message stands in a file.
struct MessagePlace {
  std::uint64_t record{};    ///< Offset of the record of its chunk, or of its own.
  std::uint64_t in_chunk{};  ///< Of its record in the uncompressed chunk.

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
  std::string profile;
  std::string library;

  template <typename Self, typename Visit>
  static void Fields(Self& self, Visit&& visit) {
    visit("profile", self.profile);
    visit("library", self.library);
  }
};

struct McapFooter {
  static constexpr McapOpcode kOpcode = McapOpcode::kFooter;
  std::uint64_t summary_start{};         ///< 0: there is no summary.
  std::uint64_t summary_offset_start{};  ///< 0: there are no summary offsets.
  std::uint32_t summary_crc{};           ///< From the summary's start to here; 0 = not available.

  template <typename Self, typename Visit>
  static void Fields(Self& self, Visit&& visit) {
    visit("summary_start", self.summary_start);
    visit("summary_offset_start", self.summary_offset_start);
    visit("summary_crc", self.summary_crc);
  }
};

struct McapSchema {
  static constexpr McapOpcode kOpcode = McapOpcode::kSchema;
  std::uint16_t id{};  ///< Not 0.
  std::string name;
  std::string encoding;  ///< "ros2msg"
  std::string data;

  template <typename Self, typename Visit>
  static void Fields(Self& self, Visit&& visit) {
    visit("id", self.id);
    visit("name", self.name);
    visit("encoding", self.encoding);
    visit("data", self.data);
  }
  bool operator==(const McapSchema&) const = default;
};

struct McapChannel {
  static constexpr McapOpcode kOpcode = McapOpcode::kChannel;
  std::uint16_t id{};
  std::uint16_t schema_id{};  ///< 0: none.
  std::string topic;
  std::string message_encoding;  ///< "cdr"
  std::map<std::string, std::string> metadata;

  template <typename Self, typename Visit>
  static void Fields(Self& self, Visit&& visit) {
    visit("id", self.id);
    visit("schema_id", self.schema_id);
    visit("topic", self.topic);
    visit("message_encoding", self.message_encoding);
    visit("metadata", self.metadata);
  }
  bool operator==(const McapChannel&) const = default;
};

struct McapMessage {
  static constexpr McapOpcode kOpcode = McapOpcode::kMessage;
  std::uint16_t channel_id{};
  std::uint32_t sequence{};
  std::uint64_t log_time{};  ///< In ns, as all times of these records.
  std::uint64_t publish_time{};
  ByteSpan data;

  template <typename Self, typename Visit>
  static void Fields(Self& self, Visit&& visit) {
    visit("channel_id", self.channel_id);
    visit("sequence", self.sequence);
    visit("log_time", self.log_time);
    visit("publish_time", self.publish_time);
    visit("data", self.data);
  }
};

/// A batch of schemas, channels and messages, compressed together.
struct McapChunk {
  static constexpr McapOpcode kOpcode = McapOpcode::kChunk;
  std::uint64_t message_start_time{};  ///< 0 without messages.
  std::uint64_t message_end_time{};
  std::uint64_t uncompressed_size{};
  std::uint32_t uncompressed_crc{};  ///< 0 = not available.
  std::string compression;           ///< "", "lz4" or "zstd"
  CountedBytes records;

  template <typename Self, typename Visit>
  static void Fields(Self& self, Visit&& visit) {
    visit("message_start_time", self.message_start_time);
    visit("message_end_time", self.message_end_time);
    visit("uncompressed_size", self.uncompressed_size);
    visit("uncompressed_crc", self.uncompressed_crc);
    visit("compression", self.compression);
    visit("records", self.records);
  }
};

/// Where in the chunk before it the messages of a channel are: log time and offset of each.
struct McapMessageIndex {
  static constexpr McapOpcode kOpcode = McapOpcode::kMessageIndex;
  std::uint16_t channel_id{};
  std::vector<std::pair<std::uint64_t, std::uint64_t>> records;

  template <typename Self, typename Visit>
  static void Fields(Self& self, Visit&& visit) {
    visit("channel_id", self.channel_id);
    visit("records", self.records);
  }
};

struct McapChunkIndex {
  static constexpr McapOpcode kOpcode = McapOpcode::kChunkIndex;
  std::uint64_t message_start_time{};
  std::uint64_t message_end_time{};
  std::uint64_t chunk_start_offset{};
  std::uint64_t chunk_length{};  ///< Of the whole record.
  std::map<std::uint16_t, std::uint64_t> message_index_offsets;
  std::uint64_t message_index_length{};
  std::string compression;
  std::uint64_t compressed_size{};
  std::uint64_t uncompressed_size{};

  template <typename Self, typename Visit>
  static void Fields(Self& self, Visit&& visit) {
    visit("message_start_time", self.message_start_time);
    visit("message_end_time", self.message_end_time);
    visit("chunk_start_offset", self.chunk_start_offset);
    visit("chunk_length", self.chunk_length);
    visit("message_index_offsets", self.message_index_offsets);
    visit("message_index_length", self.message_index_length);
    visit("compression", self.compression);
    visit("compressed_size", self.compressed_size);
    visit("uncompressed_size", self.uncompressed_size);
  }
};

/// A file inside the file.
struct McapAttachment {
  static constexpr McapOpcode kOpcode = McapOpcode::kAttachment;
  std::uint64_t log_time{};
  std::uint64_t create_time{};
  std::string name;
  std::string media_type;
  CountedBytes data;
  std::uint32_t crc{};  ///< Of the fields before it; 0 = not available.

  template <typename Self, typename Visit>
  static void Fields(Self& self, Visit&& visit) {
    visit("log_time", self.log_time);
    visit("create_time", self.create_time);
    visit("name", self.name);
    visit("media_type", self.media_type);
    visit("data", self.data);
    visit("crc", self.crc);
  }
};

struct McapAttachmentIndex {
  static constexpr McapOpcode kOpcode = McapOpcode::kAttachmentIndex;
  std::uint64_t offset{};
  std::uint64_t length{};  ///< Of the whole record.
  std::uint64_t log_time{};
  std::uint64_t create_time{};
  std::uint64_t data_size{};
  std::string name;
  std::string media_type;

  template <typename Self, typename Visit>
  static void Fields(Self& self, Visit&& visit) {
    visit("offset", self.offset);
    visit("length", self.length);
    visit("log_time", self.log_time);
    visit("create_time", self.create_time);
    visit("data_size", self.data_size);
    visit("name", self.name);
    visit("media_type", self.media_type);
  }
};

struct McapStatistics {
  static constexpr McapOpcode kOpcode = McapOpcode::kStatistics;
  std::uint64_t message_count{};
  std::uint16_t schema_count{};
  std::uint32_t channel_count{};
  std::uint32_t attachment_count{};
  std::uint32_t metadata_count{};
  std::uint32_t chunk_count{};
  std::uint64_t message_start_time{};
  std::uint64_t message_end_time{};
  std::map<std::uint16_t, std::uint64_t> channel_message_counts;

  template <typename Self, typename Visit>
  static void Fields(Self& self, Visit&& visit) {
    visit("message_count", self.message_count);
    visit("schema_count", self.schema_count);
    visit("channel_count", self.channel_count);
    visit("attachment_count", self.attachment_count);
    visit("metadata_count", self.metadata_count);
    visit("chunk_count", self.chunk_count);
    visit("message_start_time", self.message_start_time);
    visit("message_end_time", self.message_end_time);
    visit("channel_message_counts", self.channel_message_counts);
  }
};

struct McapMetadata {
  static constexpr McapOpcode kOpcode = McapOpcode::kMetadata;
  std::string name;
  std::map<std::string, std::string> metadata;

  template <typename Self, typename Visit>
  static void Fields(Self& self, Visit&& visit) {
    visit("name", self.name);
    visit("metadata", self.metadata);
  }
};

struct McapMetadataIndex {
  static constexpr McapOpcode kOpcode = McapOpcode::kMetadataIndex;
  std::uint64_t offset{};
  std::uint64_t length{};
  std::string name;

  template <typename Self, typename Visit>
  static void Fields(Self& self, Visit&& visit) {
    visit("offset", self.offset);
    visit("length", self.length);
    visit("name", self.name);
  }
};

/// Where in the summary the records of an opcode are.
struct McapSummaryOffset {
  static constexpr McapOpcode kOpcode = McapOpcode::kSummaryOffset;
  std::uint8_t group_opcode{};
  std::uint64_t group_start{};
  std::uint64_t group_length{};

  template <typename Self, typename Visit>
  static void Fields(Self& self, Visit&& visit) {
    visit("group_opcode", self.group_opcode);
    visit("group_start", self.group_start);
    visit("group_length", self.group_length);
  }
};

struct McapDataEnd {
  static constexpr McapOpcode kOpcode = McapOpcode::kDataEnd;
  std::uint32_t data_section_crc{};  ///< Of the file up to this record; 0 = not available.

  template <typename Self, typename Visit>
  static void Fields(Self& self, Visit&& visit) {
    visit("data_section_crc", self.data_section_crc);
  }
};

}  // namespace railcast::mcap
