#include "core/extras/ros/mcap/mcap_index.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/ros/mcap/record_scan.h"

namespace railcast::mcap {
namespace {

constexpr std::size_t kFooter_bytes = 20;
constexpr std::size_t kMaxSummary_bytes = std::size_t{1} << 28U;

template <typename Record>
void NoteUnique(const char* kind, const Record& record, std::map<std::uint16_t, Record>& known) {
  const auto [entry, is_new] = known.emplace(record.id, record);
  if (is_new || entry->second == record) return;
  throw InputError(std::string(kind) + " " + NumberText(record.id) +
                   ": must be the same wherever it stands in the file");
}

/// Throws if the CRC that a record states is not that of the bytes.
void CheckCrc(const char* name, std::uint32_t stated, ByteSpan bytes) {
  if (stated == 0) return;
  const std::uint32_t crc = Crc32(bytes);
  if (crc == stated) return;
  throw InputError(std::string(name) + ": must be that of the bytes, " + NumberText(crc) +
                   Got(stated));
}

void CheckCrcIsThat(const McapDataEnd& end, std::uint32_t crc) {
  if (end.data_section_crc == 0 || end.data_section_crc == crc) return;
  throw InputError("data_section_crc: must be that of the bytes before it, " + NumberText(crc) +
                   Got(end.data_section_crc));
}

std::optional<RecordPlace> FooterOf(const ByteFile& file) {
  constexpr std::size_t kEnd_bytes = kRecordHead_bytes + kFooter_bytes + kMagic.size();
  if (file.size() < kMagic.size() + kEnd_bytes) return std::nullopt;
  if (!std::ranges::equal(file.Read(file.size() - kMagic.size(), kMagic.size()), kMagic)) {
    return std::nullopt;
  }
  const auto footer = RecordAt(file, file.size() - kEnd_bytes);
  const bool is_one =
      footer && footer->opcode == McapOpcode::kFooter && footer->size == kFooter_bytes;
  return is_one ? footer : std::nullopt;
}

void NoteSummaryRecord(const RecordView& record, McapIndex& index) {
  switch (record.opcode) {
    case McapOpcode::kSchema: {
      auto schema = ReadRecord<McapSchema>(record.content);
      index.schemas.emplace(schema.id, std::move(schema));
      return;
    }
    case McapOpcode::kChannel: {
      auto channel = ReadRecord<McapChannel>(record.content);
      index.channels.emplace(channel.id, std::move(channel));
      return;
    }
    case McapOpcode::kChunkIndex:
      index.chunks.push_back(ReadRecord<McapChunkIndex>(record.content));
      return;
    case McapOpcode::kAttachmentIndex:
      index.attachments.push_back(ReadRecord<McapAttachmentIndex>(record.content));
      return;
    case McapOpcode::kMetadataIndex:
      index.metadata.push_back(ReadRecord<McapMetadataIndex>(record.content));
      return;
    case McapOpcode::kStatistics:
      index.statistics = ReadRecord<McapStatistics>(record.content);
      return;
    default:
      return;
  }
}

/// Whether a summary says all that ScanWhole() would find.
bool IsComplete(const McapIndex& index) {
  const McapStatistics& statistics = index.statistics;
  const auto knows_channels = [&](const McapChunkIndex& chunk) {
    return std::ranges::all_of(chunk.message_index_offsets, [&](const auto& entry) {
      return index.channels.contains(entry.first);
    });
  };
  const auto knows_schema = [&](const auto& entry) {
    const std::uint16_t id = entry.second.schema_id;
    return id == 0 || index.schemas.contains(id);
  };
  return (statistics.message_count == 0 || statistics.chunk_count > 0) &&
         std::ranges::all_of(index.channels, knows_schema) &&
         statistics.chunk_count == index.chunks.size() &&
         statistics.channel_count == index.channels.size() &&
         statistics.schema_count == index.schemas.size() &&
         statistics.attachment_count == index.attachments.size() &&
         statistics.metadata_count == index.metadata.size() &&
         std::ranges::all_of(index.chunks, knows_channels);
}

/// Whether the data hold as many records as the index names. Where a writer left out one of them,
/// its statistics may do so, too. Only the heads of records are read.
bool HasAllRecords(const ByteFile& file, const McapIndex& index) {
  std::size_t num_chunks = 0;
  std::size_t num_attachments = 0;
  std::size_t num_metadata = 0;
  RecordScan scan(file);
  for (auto place = scan.Next(); place && place->opcode != McapOpcode::kDataEnd;
       place = scan.Next()) {
    // A file with chunks has no index of messages beside them.
    if (place->opcode == McapOpcode::kMessage) return false;
    num_chunks += place->opcode == McapOpcode::kChunk ? 1 : 0;
    num_attachments += place->opcode == McapOpcode::kAttachment ? 1 : 0;
    num_metadata += place->opcode == McapOpcode::kMetadata ? 1 : 0;
  }
  return num_chunks == index.chunks.size() && num_attachments == index.attachments.size() &&
         num_metadata == index.metadata.size();
}

/// Records stand behind each other in the file: each has one entry of the index.
void CheckAreApart(const McapIndex& index, std::uint64_t data_end) {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> places;
  for (const auto& chunk : index.chunks) {
    places.emplace_back(chunk.chunk_start_offset, chunk.chunk_length);
  }
  for (const auto& each : index.attachments) places.emplace_back(each.offset, each.length);
  for (const auto& each : index.metadata) places.emplace_back(each.offset, each.length);
  std::ranges::sort(places);
  std::uint64_t end = kMagic.size();
  for (const auto& [offset, length] : places) {
    if (offset < end || offset > data_end || length > data_end - offset) {
      throw InputError("offset: must be that of a record of its own in the data" + Got(offset));
    }
    end = offset + std::max<std::uint64_t>(length, kRecordHead_bytes);
  }
}

/// Returns the summary's content; nothing if the file has none.
std::optional<McapIndex> ReadSummary(const ByteFile& file) {
  const auto place = FooterOf(file);
  if (!place) return std::nullopt;
  const auto footer = ReadRecord<McapFooter>(ContentOf(file, *place));
  if (footer.summary_start == 0) return std::nullopt;
  return AtPlace(PlaceOf(file, place->offset), [&] {
    if (footer.summary_start < kMagic.size() || footer.summary_start > place->offset ||
        place->offset - footer.summary_start > kMaxSummary_bytes) {
      throw InputError("summary_start: must lie in the file, at most " +
                       NumberText(kMaxSummary_bytes) + " bytes before the footer" +
                       Got(footer.summary_start));
    }
    const std::size_t size = place->offset - footer.summary_start;
    // The CRC covers the footer, too, but for its own field.
    const Bytes bytes = file.Read(
        footer.summary_start, size + kRecordHead_bytes + kFooter_bytes - sizeof footer.summary_crc);
    CheckCrc("summary_crc", footer.summary_crc, bytes);
    return AtPlace("summary: ", [&] {
      std::optional<McapIndex> index(std::in_place);
      RecordCursor cursor(ByteSpan(bytes).first(size));
      while (const auto record = cursor.Next()) NoteSummaryRecord(*record, *index);
      CheckAreApart(*index, footer.summary_start);
      return index;
    });
  });
}

McapHeader ReadHeader(const ByteFile& file) {
  const auto place = RecordScan(file).Next();
  if (!place) return {};  // The file was cut off at once.
  return AtPlace(PlaceOf(file, place->offset), [&] {
    if (place->opcode != McapOpcode::kHeader) {
      throw InputError("must be the header" + Got(static_cast<int>(place->opcode)));
    }
    return ReadRecord<McapHeader>(ContentOf(file, *place));
  });
}

void NoteRecord(const RecordPlace& place, ByteSpan content, McapIndex& index) {
  const std::uint64_t length = place.end() - place.offset;
  switch (place.opcode) {
    case McapOpcode::kHeader:
      index.header = ReadRecord<McapHeader>(content);
      return;
    case McapOpcode::kSchema:
      return index.Note(ReadRecord<McapSchema>(content));
    case McapOpcode::kChannel:
      return index.Note(ReadRecord<McapChannel>(content));
    case McapOpcode::kMessage: {
      const auto message = ReadRecord<McapMessage>(content);
      index.Note(message);
      index.loose.push_back({message.log_time, place.offset, message.channel_id});
      return;
    }
    case McapOpcode::kChunk: {
      Bytes storage;
      const ChunkContent found = NoteChunk(RecordsOfChunk(content, storage), index);
      auto chunk = ReadRecord<McapChunk>(content);
      // Times as they are, whatever the chunk says.
      chunk.message_start_time = found.start_time;
      chunk.message_end_time = found.end_time;
      McapChunkIndex& entry = AddChunk(chunk, place.offset, length, index);
      for (const auto& [channel, messages] : found.indexes) {
        entry.message_index_offsets.emplace(channel, 0);
      }
      return;
    }
    case McapOpcode::kMessageIndex: {
      if (index.chunks.empty()) return;
      McapChunkIndex& chunk = index.chunks.back();
      const std::uint16_t channel = ReadRecord<McapMessageIndex>(content).channel_id;
      chunk.message_index_offsets.insert_or_assign(channel, place.offset);
      chunk.message_index_length += length;
      return;
    }
    case McapOpcode::kAttachment: {
      const auto attachment = ReadRecord<McapAttachment>(content);
      index.attachments.push_back({place.offset, length, attachment.log_time,
                                   attachment.create_time, attachment.data.bytes.size(),
                                   attachment.name, attachment.media_type});
      ++index.statistics.attachment_count;
      return;
    }
    case McapOpcode::kMetadata:
      index.metadata.push_back({place.offset, length, ReadRecord<McapMetadata>(content).name});
      ++index.statistics.metadata_count;
      return;
    default:
      return;
  }
}

void ScanUpTo(const ByteFile& file, std::uint64_t end, ScannedFile& scanned) {
  RecordScan scan(file);
  scanned.crc = Crc32(file.Read(0, kMagic.size()));
  scanned.size = kMagic.size();
  while (const auto place = scan.Next()) {
    // What follows the end of the data repeats what stands before it.
    const bool is_end = place->opcode == McapOpcode::kDataEnd;
    if (place->end() > end) return;
    AtPlace(PlaceOf(file, place->offset), [&] {
      const Bytes content = ContentOf(file, *place);
      if (is_end) return CheckCrcIsThat(ReadRecord<McapDataEnd>(content), scanned.crc);
      NoteRecord(*place, content, scanned.index);
      scanned.crc = Crc32(file.Read(place->offset, kRecordHead_bytes), scanned.crc);
      scanned.crc = Crc32(content, scanned.crc);
    });
    if (is_end) {
      scanned.is_whole = true;
      return;
    }
    scanned.size = place->end();
  }
}

/// What stands behind the last whole record, where the data have no end; nothing if the file has.
/// @throws InputError if it is damaged rather than cut off.
std::optional<CutEnd> CutAt(const ByteFile& file, std::uint64_t offset) {
  const std::uint64_t num_bytes = file.size() - offset;
  if (num_bytes > 0 && FooterOf(file)) {
    if (num_bytes == kMagic.size()) return std::nullopt;
    std::uint64_t length{};
    FieldReader(file.Read(offset + 1, sizeof length))("length", length);
    throw InputError(PlaceOf(file, offset) + "length: must end within the file, which is complete" +
                     Got(length));
  }
  return CutEnd{offset, num_bytes};
}

/// What is wrong behind the data, which are whole: the end is cut off, or something stands behind.
/// @param offset Of the record that ends the data.
std::optional<CutEnd> FaultOfEnd(const ByteFile& file, std::uint64_t offset) {
  bool is_end = false;
  for (auto place = RecordAt(file, offset); place && !is_end; place = RecordAt(file, offset)) {
    is_end = place->opcode == McapOpcode::kFooter;
    offset = place->end();
  }
  const std::uint64_t num_bytes = file.size() - offset;
  const bool is_whole = is_end && num_bytes >= kMagic.size() &&
                        std::ranges::equal(file.Read(offset, kMagic.size()), kMagic);
  if (!is_whole) return CutEnd{offset, num_bytes};
  if (num_bytes == kMagic.size()) return std::nullopt;
  return CutEnd{offset + kMagic.size(), num_bytes - kMagic.size(), true};
}

}  // namespace

void McapIndex::Note(const McapSchema& schema) {
  if (schema.id == 0) return;
  NoteUnique("schema", schema, schemas);
  statistics.schema_count = static_cast<std::uint16_t>(schemas.size());
}

void McapIndex::Note(const McapChannel& channel) {
  if (channel.schema_id != 0 && !schemas.contains(channel.schema_id)) {
    throw InputError("channel " + NumberText(channel.id) + ": must have a schema of the file" +
                     Got(channel.schema_id));
  }
  NoteUnique("channel", channel, channels);
  statistics.channel_count = static_cast<std::uint32_t>(channels.size());
}

void McapIndex::Note(const McapMessage& message) {
  if (!channels.contains(message.channel_id)) {
    throw InputError("channel_id: must be a channel that stands before the message" +
                     Got(message.channel_id));
  }
  const bool is_first = statistics.message_count++ == 0;
  const std::uint64_t time = message.log_time;
  statistics.message_start_time = is_first ? time : std::min(statistics.message_start_time, time);
  statistics.message_end_time = std::max(statistics.message_end_time, time);
  ++statistics.channel_message_counts[message.channel_id];
}

void ChunkContent::Add(const McapMessage& message, std::uint64_t offset) {
  start_time = indexes.empty() ? message.log_time : std::min(start_time, message.log_time);
  end_time = std::max(end_time, message.log_time);
  McapMessageIndex& entries = indexes[message.channel_id];
  entries.channel_id = message.channel_id;
  entries.records.emplace_back(message.log_time, offset);
}

ChunkContent NoteChunk(ByteSpan records, McapIndex& index) {
  ChunkContent content;
  RecordCursor cursor(records);
  while (const auto record = cursor.Next()) {
    AtPlace("record at " + NumberText(record->offset) + ": ", [&] {
      if (record->opcode == McapOpcode::kSchema) {
        index.Note(ReadRecord<McapSchema>(record->content));
      } else if (record->opcode == McapOpcode::kChannel) {
        index.Note(ReadRecord<McapChannel>(record->content));
      } else if (record->opcode == McapOpcode::kMessage) {
        const auto message = ReadRecord<McapMessage>(record->content);
        index.Note(message);
        content.Add(message, record->offset);
      }
    });
  }
  return content;
}

McapChunkIndex& AddChunk(const McapChunk& chunk,
                         std::uint64_t offset,
                         std::uint64_t length,
                         McapIndex& index) {
  ++index.statistics.chunk_count;
  return index.chunks.emplace_back(McapChunkIndex{.message_start_time = chunk.message_start_time,
                                                  .message_end_time = chunk.message_end_time,
                                                  .chunk_start_offset = offset,
                                                  .chunk_length = length,
                                                  .message_index_offsets = {},
                                                  .message_index_length = 0,
                                                  .compression = chunk.compression,
                                                  .compressed_size = chunk.records.bytes.size(),
                                                  .uncompressed_size = chunk.uncompressed_size});
}

ScannedFile ScanWhole(const ByteFile& file, std::uint64_t end) {
  ScannedFile scanned;
  ScanUpTo(file, end, scanned);
  return scanned;
}

ScannedFile ScanUndamaged(const ByteFile& file) {
  ScannedFile scanned;
  try {
    ScanUpTo(file, file.size(), scanned);
  } catch (const InputError&) {
    // What stands before is whole.
  }
  return scanned;
}

McapIndex ReadIndex(const ByteFile& file) {
  McapHeader header = ReadHeader(file);
  auto index = ReadSummary(file);
  if (!index || !IsComplete(*index) || !HasAllRecords(file, *index)) {
    ScannedFile scanned = ScanWhole(file, file.size());
    index = std::move(scanned.index);
    index->cut = scanned.is_whole ? FaultOfEnd(file, scanned.size) : CutAt(file, scanned.size);
  }
  index->header = std::move(header);
  return std::move(*index);
}

}  // namespace railcast::mcap
