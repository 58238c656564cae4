#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/extras/ros/mcap/byte_file.h"
#include "core/extras/ros/mcap/mcap_records.h"
#include "core/extras/ros/mcap/record_codec.h"

namespace railcast::mcap {

/// A message that is in no chunk.
struct LooseMessage {
  std::uint64_t log_time{};
  std::uint64_t offset{};  ///< Offset of its record in the file.
  std::uint16_t channel_id{};
};

/// The end of a file that was cut off within a record, or has more behind its end.
struct CutEnd {
  std::uint64_t offset{};     ///< Where the last whole record ends.
  std::uint64_t num_bytes{};  ///< Bytes that follow it.
  bool is_surplus{};          ///< Whether they stand behind the end.
};

/// What an MCAP file holds and where, as its summary says it.
struct McapIndex {
  McapHeader header;
  std::map<std::uint16_t, McapSchema> schemas;
  std::map<std::uint16_t, McapChannel> channels;
  std::vector<McapChunkIndex> chunks;
  std::vector<McapAttachmentIndex> attachments;
  std::vector<McapMetadataIndex> metadata;
  McapStatistics statistics;
  std::vector<LooseMessage> loose;  ///< In the order of the file; only of a file without summary.
  std::optional<CutEnd> cut{};      ///< Only of a file without summary.

  /// Notes a schema, unless its id is 0.
  /// @throws InputError "schema 3: rule" if another one has its id.
  void Note(const McapSchema& schema);
  /// @throws InputError "channel 3: rule" if another one has its id, or its schema is unknown.
  void Note(const McapChannel& channel);
  /// Counts a message.
  /// @throws InputError "channel_id: rule (got value)" if its channel is unknown.
  void Note(const McapMessage& message);
};

/// The times of the messages of a chunk that is being written or scanned, and where they are.
struct ChunkContent {
  std::uint64_t start_time{};
  std::uint64_t end_time{};
  /// By channel, in the order of the chunk.
  std::map<std::uint16_t, McapMessageIndex> indexes;

  /// Adds the message of the record at `offset` in the chunk.
  void Add(const McapMessage& message, std::uint64_t offset);
};

/// Notes what the records of a chunk hold.
/// @throws InputError "record at N: rule (got value)" if one is damaged.
[[nodiscard]] ChunkContent NoteChunk(ByteSpan records, McapIndex& index);

/// Adds the chunk's entry to the index.
/// @param offset Of its record, of `length` bytes.
/// @returns The entry, of which the message indexes are still to be filled in.
McapChunkIndex& AddChunk(const McapChunk& chunk,
                         std::uint64_t offset,
                         std::uint64_t length,
                         McapIndex& index);

/// Returns what the file holds: as its summary says if that is complete, else as found by reading
/// the whole file, up to where it was cut off.
/// @throws InputError "file: place: rule (got value)" if the file is no MCAP file or damaged: so is
///   a record that does not fit into a file which has its end.
[[nodiscard]] McapIndex ReadIndex(const ByteFile& file);

/// What was found in the data section of a file, without its summary.
struct ScannedFile {
  McapIndex index;
  std::uint64_t size{};  ///< Where the last record ends that was found whole.
  std::uint32_t crc{};   ///< CRC of the file up to there.
  bool is_whole{};       ///< Whether the end of the data was found.
};

/// As ReadIndex(), without the summary.
/// @param end Records that end behind this place are left out, and what follows them.
[[nodiscard]] ScannedFile ScanWhole(const ByteFile& file, std::uint64_t end);

/// As ScanWhole(), up to the first record that is damaged, as a power cut may leave it.
[[nodiscard]] ScannedFile ScanUndamaged(const ByteFile& file);

}  // namespace railcast::mcap
