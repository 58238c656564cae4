#include "core/extras/ros/mcap/mcap_copy.h"

#include <algorithm>
#include <cstring>
#include <span>

#include "core/base/error.h"
#include "core/extras/ros/mcap/compression.h"
#include "core/extras/ros/mcap/record_codec.h"

namespace railcast::mcap {
namespace {

/// Chunks whose indexes say that they hold no message of these channels.
std::set<std::uint64_t> ChunksWithout(const std::set<std::uint16_t>& channels,
                                      const McapIndex& index) {
  std::set<std::uint64_t> chunks;
  for (const McapChunkIndex& chunk : index.chunks) {
    const auto& offsets = chunk.message_index_offsets;
    const bool has_any = offsets.empty() || std::ranges::any_of(offsets, [&](const auto& entry) {
                           return channels.contains(entry.first);
                         });
    if (!has_any) chunks.insert(chunk.chunk_start_offset);
  }
  return chunks;
}

}  // namespace

McapCopy::McapCopy(const std::filesystem::path& file,
                   std::string name,
                   Sink sink,
                   std::set<std::uint16_t> channels)
    : file_(file, std::move(name)),
      sink_(std::move(sink)),
      channels_(std::move(channels)),
      other_chunks_(ChunksWithout(channels_, ReadIndex(file_))),
      scan_(file_) {
  CopyBytes(0, kMagic.size());
}

void McapCopy::Put(const MessagePlace& place, std::optional<Bytes> data) {
  decided_.insert_or_assign(place, std::move(data));
  Advance();
}

void McapCopy::Finish() {
  is_finishing_ = true;
  Advance();
  CopyBytes(copied_, file_.size());
}

void McapCopy::Advance() {
  while (true) {
    if (!next_) {
      next_ = scan_.Next();
      if (!next_) return;
      Enter(*next_);
    }
    if (!is_finishing_ && !IsDecided()) return;
    AtPlace(PlaceOf(file_, next_->offset), [&] { WriteNext(); });
    copied_ = next_->end();
    const auto shift = static_cast<std::int64_t>(size_ - copied_);
    if ((shifts_.empty() ? 0 : shifts_.back().second) != shift)
      shifts_.emplace_back(copied_, shift);
    decided_.erase(decided_.begin(), decided_.lower_bound({next_->end(), 0}));
    next_.reset();
  }
}

/// Finds the messages that are waited for in a record.
void McapCopy::Enter(const RecordPlace& record) {
  content_.clear();
  messages_.clear();
  if (record.opcode == McapOpcode::kMessage) {
    content_ = ContentOf(file_, record);
    if (channels_.contains(ReadRecord<McapMessage>(content_).channel_id)) messages_ = {0};
  }
  if (record.opcode != McapOpcode::kChunk || other_chunks_.contains(record.offset)) return;
  content_ = ContentOf(file_, record);
  AtPlace(PlaceOf(file_, record.offset), [&] {
    Bytes storage;
    RecordCursor cursor(RecordsOfChunk(content_, storage));
    while (const auto inner = cursor.Next()) {
      if (inner->opcode != McapOpcode::kMessage) continue;
      const auto message = ReadRecord<McapMessage>(inner->content);
      if (channels_.contains(message.channel_id)) messages_.push_back(inner->offset);
    }
  });
}

bool McapCopy::IsDecided() const {
  return std::ranges::all_of(messages_, [&](std::uint64_t in_chunk) {
    return decided_.contains({next_->offset, in_chunk});
  });
}

const Bytes* McapCopy::DataAt(std::uint64_t in_chunk) const {
  const auto found = decided_.find({next_->offset, in_chunk});
  return found == decided_.end() || !found->second ? nullptr : &*found->second;
}

void McapCopy::WriteNext() {
  const bool has_other_data = std::ranges::any_of(
      messages_, [&](std::uint64_t in_chunk) { return DataAt(in_chunk) != nullptr; });
  has_changed_ = has_changed_ || has_other_data;
  if (next_->opcode == McapOpcode::kChunk) moved_.clear();
  if (has_other_data) return next_->opcode == McapOpcode::kChunk ? WriteChunk() : WriteMessage();
  if (!has_changed_) {
    CopyBytes(next_->offset, next_->end());
    return;
  }
  switch (next_->opcode) {
    case McapOpcode::kMessageIndex:
      return WriteMessageIndex();
    case McapOpcode::kChunkIndex:
      return WriteChunkIndex();
    case McapOpcode::kFooter:
      return WriteFooter();
    case McapOpcode::kDataEnd:
      Rewrite<McapDataEnd>([&](McapDataEnd& end) {
        if (end.data_section_crc != 0) end.data_section_crc = crc_;
      });
      crc_ = 0;
      data_end_ = next_->end();
      return;
    case McapOpcode::kAttachmentIndex:
      return Rewrite<McapAttachmentIndex>(
          [&](McapAttachmentIndex& index) { index.offset = Moved(index.offset); });
    case McapOpcode::kMetadataIndex:
      return Rewrite<McapMetadataIndex>(
          [&](McapMetadataIndex& index) { index.offset = Moved(index.offset); });
    case McapOpcode::kSummaryOffset:
      return Rewrite<McapSummaryOffset>([&](McapSummaryOffset& group) {
        const std::uint64_t end = Moved(group.group_start + group.group_length);
        group.group_start = Moved(group.group_start);
        group.group_length = end - group.group_start;
      });
    default:
      CopyBytes(next_->offset, next_->end());
  }
}

void McapCopy::WriteChunk() {
  Bytes storage;
  const ByteSpan before = RecordsOfChunk(content_, storage);
  Bytes records;
  RecordCursor cursor(before);
  while (const auto inner = cursor.Next()) {
    moved_.emplace(inner->offset, records.size());
    if (const Bytes* const data = DataAt(inner->offset)) {
      auto message = ReadRecord<McapMessage>(inner->content);
      message.data = *data;
      AppendRecord(message, records);
      continue;
    }
    const ByteSpan record =
        before.subspan(inner->offset, kRecordHead_bytes + inner->content.size());
    records.insert(records.end(), record.begin(), record.end());
  }
  const std::uint64_t start = size_;
  Bytes compressed;
  Rewrite<McapChunk>([&](McapChunk& chunk) {
    compressed = Compressed(records, ValueNamed<McapCompression>(chunk.compression).value());
    chunk.uncompressed_size = records.size();
    if (chunk.uncompressed_crc != 0) chunk.uncompressed_crc = Crc32(records);
    chunk.records = {compressed};
  });
  McapChunkIndex& changed = changed_[next_->offset];
  changed.chunk_length = size_ - start;
  changed.compressed_size = compressed.size();
  changed.uncompressed_size = records.size();
}

void McapCopy::WriteMessage() {
  Rewrite<McapMessage>([&](McapMessage& message) { message.data = *DataAt(0); });
}

void McapCopy::WriteMessageIndex() {
  Rewrite<McapMessageIndex>([&](McapMessageIndex& index) {
    for (auto& [time, offset] : index.records) {
      const auto moved = moved_.find(offset);
      if (moved != moved_.end()) offset = moved->second;
    }
  });
}

void McapCopy::WriteChunkIndex() {
  Rewrite<McapChunkIndex>([&](McapChunkIndex& index) {
    if (const auto changed = changed_.find(index.chunk_start_offset); changed != changed_.end()) {
      index.chunk_length = changed->second.chunk_length;
      index.compressed_size = changed->second.compressed_size;
      index.uncompressed_size = changed->second.uncompressed_size;
    }
    index.chunk_start_offset = Moved(index.chunk_start_offset);
    for (auto& [channel, offset] : index.message_index_offsets) offset = Moved(offset);
  });
}

void McapCopy::WriteFooter() {
  content_ = ContentOf(file_, *next_);
  auto footer = ReadRecord<McapFooter>(content_);
  // Without a summary it is that of the footer alone.
  const std::uint64_t start = footer.summary_start == 0 ? next_->offset : footer.summary_start;
  const bool has_crc = footer.summary_crc != 0 && start == data_end_;
  if (footer.summary_start != 0) footer.summary_start = Moved(footer.summary_start);
  if (footer.summary_offset_start != 0) {
    footer.summary_offset_start = Moved(footer.summary_offset_start);
  }
  footer.summary_crc = 0;
  Bytes record;
  AppendRecord(footer, record);
  if (has_crc) {
    footer.summary_crc =
        Crc32(ByteSpan(record).first(record.size() - sizeof footer.summary_crc), crc_);
  }
  record.clear();
  AppendRecord(footer, record);
  PutBytes(record);
}

// What follows the known fields of a record, as of later versions, stays.
template <typename Record, typename Change>
void McapCopy::Rewrite(const Change& change) {
  if (content_.empty()) content_ = ContentOf(file_, *next_);
  auto record = ReadRecord<Record>(content_);
  Bytes bytes;
  AppendRecord(record, bytes);
  const ByteSpan rest =
      ByteSpan(content_).subspan(std::min(bytes.size() - kRecordHead_bytes, content_.size()));
  change(record);
  bytes.clear();
  AppendRecord(record, bytes);
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  const std::uint64_t size = bytes.size() - kRecordHead_bytes;
  std::memcpy(bytes.data() + 1, &size, sizeof size);
  PutBytes(bytes);
}

void McapCopy::CopyBytes(std::uint64_t begin, std::uint64_t end) {
  constexpr std::uint64_t kBlock_bytes = std::uint64_t{1} << 20U;
  for (; begin < end; begin += kBlock_bytes) {
    PutBytes(file_.Read(begin, static_cast<std::size_t>(std::min(kBlock_bytes, end - begin))));
  }
  copied_ = end;
}

void McapCopy::PutBytes(ByteSpan bytes) {
  crc_ = Crc32(bytes, crc_);
  size_ += bytes.size();
  sink_(bytes);
}

std::uint64_t McapCopy::Moved(std::uint64_t place) const {
  const auto after =
      std::ranges::upper_bound(shifts_, place, {}, [](const auto& entry) { return entry.first; });
  if (after == shifts_.begin()) return place;
  return place + static_cast<std::uint64_t>(std::prev(after)->second);
}

}  // namespace railcast::mcap
