#include "core/extras/ros/mcap/mcap_writer.h"

#include <array>
#include <map>
#include <string>
#include <type_traits>
#include <utility>

#include "core/base/error.h"
#include "core/extras/ros/mcap/record_codec.h"

namespace railcast::mcap {

McapWriter::McapWriter(Sink sink,
                       const McapHeader& header,
                       McapCompression compression,
                       const McapFeatures& features)
    : sink_(std::move(sink)), compression_(compression), features_(features) {
  index_.header = header;
  PutBytes(kMagic);
  Put(header);
}

McapWriter::McapWriter(
    Sink sink, McapIndex index, McapCompression compression, std::uint64_t size, std::uint32_t crc)
    : sink_(std::move(sink)),
      compression_(compression),
      index_(std::move(index)),
      size_(size),
      crc_(crc) {}

void McapWriter::PutBytes(ByteSpan bytes) {
  crc_ = Crc32(bytes, crc_);
  size_ += bytes.size();
  sink_(bytes);
}

/// Writes a record and returns its length.
template <typename Record>
std::uint64_t McapWriter::Put(const Record& record) {
  buffer_.clear();
  AppendRecord(record, buffer_);
  PutBytes(buffer_);
  return buffer_.size();
}

template <typename Record>
void McapWriter::WriteBatched(const Record& record) {
  index_.Note(record);
  if (features_.has_chunks) {
    AppendRecord(record, chunk_);
  } else {
    Put(record);
  }
}

void McapWriter::Write(const McapSchema& schema) {
  WriteBatched(schema);
}

void McapWriter::Write(const McapChannel& channel) {
  WriteBatched(channel);
}

void McapWriter::Write(const McapMessage& message) {
  if (features_.has_chunks) chunk_content_.Add(message, chunk_.size());
  WriteBatched(message);
}

void McapWriter::Write(McapAttachment attachment) {
  buffer_.clear();
  attachment.crc = 0;
  AppendRecord(attachment, buffer_);
  attachment.crc = Crc32(ByteSpan(buffer_)
                             .subspan(kRecordHead_bytes)
                             .first(buffer_.size() - kRecordHead_bytes - sizeof attachment.crc));
  const std::uint64_t offset = size_;
  const std::uint64_t length = Put(attachment);
  index_.attachments.push_back({offset, length, attachment.log_time, attachment.create_time,
                                attachment.data.bytes.size(), attachment.name,
                                attachment.media_type});
  ++index_.statistics.attachment_count;
}

void McapWriter::Write(const McapMetadata& metadata) {
  const std::uint64_t offset = size_;
  const std::uint64_t length = Put(metadata);
  index_.metadata.push_back({offset, length, metadata.name});
  ++index_.statistics.metadata_count;
}

void McapWriter::PutMessageIndexes(McapChunkIndex& entry) {
  const std::uint64_t start = size_;
  for (const auto& [channel, messages] : chunk_content_.indexes) {
    entry.message_index_offsets.emplace(channel, size_);
    Put(messages);
  }
  entry.message_index_length = size_ - start;
}

void McapWriter::EndChunk() {
  if (chunk_.empty()) return;
  const Bytes records = Compressed(chunk_, compression_);
  const McapChunk chunk{.message_start_time = chunk_content_.start_time,
                        .message_end_time = chunk_content_.end_time,
                        .uncompressed_size = chunk_.size(),
                        .uncompressed_crc = Crc32(chunk_),
                        .compression = std::string(NameOf(compression_)),
                        .records = {records}};
  const std::uint64_t offset = size_;
  const std::uint64_t length = Put(chunk);
  McapChunkIndex& entry = AddChunk(chunk, offset, length, index_);
  if (features_.has_message_indexes) PutMessageIndexes(entry);
  chunk_.clear();
  chunk_content_ = {};
}

/// Writes the records of one opcode, which are the values of a map, a list or one alone.
template <typename Records>
void McapWriter::PutGroup(const Records& records, bool is_wanted) {
  if (!is_wanted || records.empty()) return;
  const std::uint64_t start = size_;
  std::uint8_t opcode = 0;
  for (const auto& record : records) {
    if constexpr (requires { record.second; }) {
      opcode = static_cast<std::uint8_t>(record.second.kOpcode);
      Put(record.second);
    } else {
      opcode = static_cast<std::uint8_t>(record.kOpcode);
      Put(record);
    }
  }
  groups_.push_back({opcode, start, size_ - start});
}

void McapWriter::PutSummary() {
  PutGroup(index_.schemas, features_.repeats_schemas);
  PutGroup(index_.channels, features_.repeats_channels);
  PutGroup(std::array{index_.statistics}, features_.has_statistics);
  PutGroup(index_.chunks, features_.has_chunk_indexes);
  PutGroup(index_.attachments, features_.has_attachment_indexes);
  PutGroup(index_.metadata, features_.has_metadata_indexes);
}

void McapWriter::Finish() {
  EndChunk();
  Put(McapDataEnd{crc_});
  const std::uint64_t summary_start = size_;
  crc_ = 0;
  PutSummary();
  McapFooter footer{.summary_start = size_ > summary_start ? summary_start : 0,
                    .summary_offset_start = 0,
                    .summary_crc = 0};
  if (features_.has_summary_offsets && !groups_.empty()) {
    footer.summary_offset_start = size_;
    for (const McapSummaryOffset& group : groups_) Put(group);
  }
  buffer_.clear();
  AppendRecord(footer, buffer_);
  footer.summary_crc =
      Crc32(ByteSpan(buffer_).first(buffer_.size() - sizeof footer.summary_crc), crc_);
  Put(footer);
  PutBytes(kMagic);
}

}  // namespace railcast::mcap
