#include "core/extras/ros/mcap/mcap_reader.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/ros/mcap/record_codec.h"
#include "core/extras/ros/mcap/record_scan.h"

namespace railcast::mcap {
namespace {

/// Returns the content of the record at a place where an index says that there is one of this
/// opcode.
/// @param length Of the whole record, if the index says it.
Bytes ContentAt(const ByteFile& file,
                std::uint64_t offset,
                McapOpcode opcode,
                std::optional<std::uint64_t> length) {
  const auto place = RecordAt(file, offset);
  if (!place || place->opcode != opcode) {
    throw InputError(PlaceOf(file, offset) + "must be there whole and of opcode " +
                     NumberText(static_cast<int>(opcode)) + ", as the index says");
  }
  if (length && place->end() - offset != *length) {
    throw InputError(PlaceOf(file, offset) + "must have " + NumberText(*length) +
                     " bytes, as the index says" + Got(place->end() - offset));
  }
  return ContentOf(file, *place);
}

}  // namespace

bool McapReader::Waiting::operator<(const Waiting& other) const {
  const auto key = [](const Waiting& message) {
    return std::tuple(message.log_time, message.file_offset, message.chunk_offset);
  };
  return key(*this) > key(other);
}

McapReader::McapReader(const std::filesystem::path& file, std::string name, std::size_t held_bytes)
    : file_(file, std::move(name)),
      index_(ReadIndex(file_)),
      by_time_(index_.chunks.size()),
      max_held_bytes_(held_bytes) {
  std::iota(by_time_.begin(), by_time_.end(), std::size_t{0});
  std::ranges::stable_sort(
      by_time_, {}, [&](std::size_t number) { return index_.chunks[number].message_start_time; });
  for (const LooseMessage& message : index_.loose) {
    waiting_.push({message.log_time, message.offset, 0, kNoChunk});
  }
}

void McapReader::Select(std::set<std::uint16_t> channels) {
  wanted_ = std::move(channels);
  num_entered_ = 0;
  num_read_.clear();
  waiting_ = {};
  num_waiting_.clear();
  finished_.reset();
  for (const LooseMessage& message : index_.loose) {
    if (wanted_->contains(message.channel_id)) {
      waiting_.push({message.log_time, message.offset, 0, kNoChunk});
    }
  }
}

bool McapReader::IsWanted(const McapChunkIndex& chunk) const {
  // Without message indexes, the chunk must be looked into.
  if (!wanted_ || chunk.message_index_offsets.empty()) return true;
  return std::ranges::any_of(chunk.message_index_offsets,
                             [&](const auto& entry) { return wanted_->contains(entry.first); });
}

void McapReader::Enter(std::size_t number) {
  const McapChunkIndex& chunk = index_.chunks[number];
  if (!IsWanted(chunk)) return;
  RecordCursor cursor(Hold(number).records);
  AtPlace(PlaceOf(file_, chunk.chunk_start_offset), [&] {
    while (const auto record = cursor.Next()) {
      if (record->opcode != McapOpcode::kMessage) continue;
      const auto message = ReadRecord<McapMessage>(record->content);
      if (!index_.channels.contains(message.channel_id)) {
        throw InputError("channel_id: must be a channel of the file" + Got(message.channel_id));
      }
      if (message.log_time < chunk.message_start_time) {
        throw InputError("log_time: must be at or after the start that the index says, " +
                         NumberText(chunk.message_start_time) + Got(message.log_time));
      }
      if (wanted_ && !wanted_->contains(message.channel_id)) continue;
      waiting_.push({message.log_time, chunk.chunk_start_offset, record->offset, number});
      ++num_waiting_[number];
    }
  });
  if (!num_waiting_.contains(number)) LetGo(number);
}

const McapReader::HeldChunk& McapReader::Hold(std::size_t number) {
  const auto known = std::ranges::find(held_, number, &HeldChunk::number);
  if (known != held_.end()) {
    held_.splice(held_.begin(), held_, known);
    return held_.front();
  }
  const std::uint64_t offset = index_.chunks[number].chunk_start_offset;
  HeldChunk chunk{.number = number, .content = {}, .storage = {}, .records = {}};
  chunk.content = ContentAt(file_, offset, McapOpcode::kChunk, index_.chunks[number].chunk_length);
  AtPlace(PlaceOf(file_, offset),
          [&] { chunk.records = RecordsOfChunk(chunk.content, chunk.storage); });
  // What was compressed is not needed any more.
  if (!chunk.storage.empty()) chunk.content = {};
  held_bytes_ += chunk.size();
  held_.push_front(std::move(chunk));
  while (held_bytes_ > max_held_bytes_ && held_.size() > 1) LetGo(held_.back().number);
  return held_.front();
}

void McapReader::LetGo(std::size_t number) {
  const auto known = std::ranges::find(held_, number, &HeldChunk::number);
  if (known == held_.end()) return;
  held_bytes_ -= known->size();
  held_.erase(known);
}

void McapReader::CheckCounts() const {
  const McapStatistics& statistics = index_.statistics;
  const auto count_in = [](const auto& counts, std::uint16_t channel) {
    const auto known = counts.find(channel);
    return known == counts.end() ? 0 : known->second;
  };
  // They are optional.
  if (statistics.channel_message_counts.empty() && statistics.message_count > 0) return;
  for (const auto& [id, channel] : index_.channels) {
    if (wanted_ && !wanted_->contains(id)) continue;
    const std::uint64_t stated = count_in(statistics.channel_message_counts, id);
    const std::uint64_t got = count_in(num_read_, id);
    if (got == stated) continue;
    throw InputError(file_.name() + ": must have as many messages of channel " + NumberText(id) +
                     " as its statistics say, " + NumberText(stated) + Got(got));
  }
}

std::optional<McapMessage> McapReader::Next() {
  if (finished_) LetGo(*std::exchange(finished_, std::nullopt));
  const auto is_due = [&] {
    if (num_entered_ == by_time_.size()) return false;
    const McapChunkIndex& chunk = index_.chunks[by_time_[num_entered_]];
    return waiting_.empty() || chunk.message_start_time <= waiting_.top().log_time;
  };
  while (is_due()) Enter(by_time_[num_entered_++]);
  if (waiting_.empty()) {
    CheckCounts();
    return std::nullopt;
  }
  const Waiting next = waiting_.top();
  waiting_.pop();
  place_ = {next.file_offset, next.chunk_offset};
  if (next.chunk == kNoChunk) {
    loose_ = ContentAt(file_, next.file_offset, McapOpcode::kMessage, std::nullopt);
    const auto message = ReadRecord<McapMessage>(loose_);
    ++num_read_[message.channel_id];
    return message;
  }
  if (--num_waiting_[next.chunk] == 0) {
    num_waiting_.erase(next.chunk);
    finished_ = next.chunk;
  }
  RecordCursor cursor(Hold(next.chunk).records.subspan(next.chunk_offset));
  const auto message = ReadRecord<McapMessage>(cursor.Next()->content);
  ++num_read_[message.channel_id];
  return message;
}

Bytes McapReader::ReadAttachment(const McapAttachmentIndex& attachment) const {
  Bytes content = ContentAt(file_, attachment.offset, McapOpcode::kAttachment, attachment.length);
  AtPlace(PlaceOf(file_, attachment.offset), [&] {
    const auto record = ReadRecord<McapAttachment>(content);
    // The CRC is of what stands before it.
    const auto before = static_cast<std::size_t>(record.data.bytes.data() +
                                                 record.data.bytes.size() - content.data());
    const std::uint32_t crc = Crc32(ByteSpan(content).first(before));
    if (record.crc != 0 && record.crc != crc) {
      throw InputError("crc: must be that of the bytes before it, " + NumberText(crc) +
                       Got(record.crc));
    }
  });
  return content;
}

}  // namespace railcast::mcap
