#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "core/extras/ros/mcap/compression.h"
#include "core/extras/ros/mcap/mcap_index.h"
#include "core/extras/ros/mcap/mcap_records.h"

namespace railcast::mcap {

/// What a file has beside its messages, each of them optional in the specification. Bags have all
/// of it.
struct McapFeatures {
  bool has_chunks = true;
  bool has_message_indexes = true;
  bool has_chunk_indexes = true;
  bool has_statistics = true;
  bool repeats_schemas = true;  ///< In the summary.
  bool repeats_channels = true;
  bool has_attachment_indexes = true;
  bool has_metadata_indexes = true;
  bool has_summary_offsets = true;
};

/// Writes an MCAP file. The same calls give the same bytes.
class McapWriter {
 public:
  /// Takes the file's bytes from its begin to its end.
  using Sink = std::function<void(ByteSpan bytes)>;

  /// Begins a file: writes its magic and header.
  McapWriter(Sink sink,
             const McapHeader& header,
             McapCompression compression,
             const McapFeatures& features);

  /// Goes on with a file.
  /// @param index What it holds, with the offsets of its message indexes.
  /// @param size Its size in bytes.
  /// @param crc The CRC-32 of these.
  McapWriter(Sink sink,
             McapIndex index,
             McapCompression compression,
             std::uint64_t size,
             std::uint32_t crc);

  /// Adds a schema before the next message.
  void Write(const McapSchema& schema);
  /// @pre Its schema was written.
  void Write(const McapChannel& channel);
  /// @pre Its channel was written.
  void Write(const McapMessage& message);
  /// Adds an attachment, before the chunk that is being made. Its CRC is computed here.
  void Write(McapAttachment attachment);
  void Write(const McapMetadata& metadata);

  /// Ends the chunk that is being made, if there is one.
  void EndChunk();
  /// Ends the file.
  void Finish();

  [[nodiscard]] const McapIndex& index() const { return index_; }

 private:
  template <typename Record>
  void WriteBatched(const Record& record);
  template <typename Record>
  std::uint64_t Put(const Record& record);
  void PutBytes(ByteSpan bytes);
  void PutMessageIndexes(McapChunkIndex& entry);
  template <typename Records>
  void PutGroup(const Records& records, bool is_wanted);
  void PutSummary();

  Sink sink_;
  McapCompression compression_;
  McapFeatures features_;
  McapIndex index_;
  std::uint64_t size_{};  ///< Size of the file so far.
  std::uint32_t crc_{};   ///< CRC of the section that is being written.
  Bytes buffer_;

  Bytes chunk_;  ///< The records of the chunk that is being made.
  ChunkContent chunk_content_;
  std::vector<McapSummaryOffset> groups_;
};

}  // namespace railcast::mcap
