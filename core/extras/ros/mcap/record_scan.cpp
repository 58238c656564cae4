#include "core/extras/ros/mcap/record_scan.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/ros/mcap/compression.h"
#include "core/extras/ros/mcap/record_codec.h"

namespace railcast::mcap {

std::string PlaceOf(const ByteFile& file, std::uint64_t offset) {
  return file.name() + ": record at " + NumberText(offset) + ": ";
}

std::optional<RecordPlace> RecordAt(const ByteFile& file, std::uint64_t offset) {
  if (offset > file.size() || file.size() - offset < kRecordHead_bytes) return std::nullopt;
  const Bytes head = file.Read(offset, kRecordHead_bytes);
  FieldReader read(head);
  std::uint8_t opcode{};
  RecordPlace record{.opcode = {}, .offset = offset, .size = 0};
  read("opcode", opcode);
  read("length", record.size);
  record.opcode = static_cast<McapOpcode>(opcode);
  if (record.size > file.size() - offset - kRecordHead_bytes) return std::nullopt;
  return record;
}

Bytes ContentOf(const ByteFile& file, const RecordPlace& record) {
  if (record.size > kMaxUncompressed_bytes) {
    throw InputError(PlaceOf(file, record.offset) + "must have at most " +
                     NumberText(kMaxUncompressed_bytes) + " bytes" + Got(record.size));
  }
  return file.Read(record.offset + kRecordHead_bytes, record.size);
}

ByteSpan RecordsOfChunk(ByteSpan content, Bytes& storage) {
  const auto chunk = ReadRecord<McapChunk>(content);
  const auto compression = ValueNamed<McapCompression>(chunk.compression);
  if (!compression) {
    throw InputError("compression: must be \"\", \"lz4\" or \"zstd\" (got " +
                     Quoted(chunk.compression) + ")");
  }
  if (chunk.uncompressed_size > kMaxUncompressed_bytes) {
    throw InputError("uncompressed_size: must be at most " + NumberText(kMaxUncompressed_bytes) +
                     Got(chunk.uncompressed_size));
  }
  ByteSpan records = chunk.records.bytes;
  if (*compression != McapCompression::kNone) {
    storage = AtPlace("records: ",
                      [&] { return Uncompressed(records, *compression, chunk.uncompressed_size); });
    records = storage;
  }
  if (records.size() != chunk.uncompressed_size) {
    throw InputError("records: must become " + NumberText(chunk.uncompressed_size) + " bytes" +
                     Got(records.size()));
  }
  const std::uint32_t crc = chunk.uncompressed_crc == 0 ? 0 : Crc32(records);
  if (crc != chunk.uncompressed_crc) {
    throw InputError("uncompressed_crc: must be that of the records, " + NumberText(crc) +
                     Got(chunk.uncompressed_crc));
  }
  return records;
}

bool BeginsAsMcap(const ByteFile& file) {
  return file.size() >= kMagic.size() && std::ranges::equal(file.Read(0, kMagic.size()), kMagic);
}

RecordScan::RecordScan(const ByteFile& file) : file_(file), place_(kMagic.size()) {
  if (!BeginsAsMcap(file)) throw InputError(file.name() + ": must begin as an MCAP file");
}

std::optional<RecordPlace> RecordScan::Next() {
  if (is_footer_read_) {
    is_complete_ = file_.size() == place_ + kMagic.size() &&
                   std::ranges::equal(file_.Read(place_, kMagic.size()), kMagic);
    return std::nullopt;
  }
  const auto record = RecordAt(file_, place_);
  if (!record) return std::nullopt;
  is_footer_read_ = record->opcode == McapOpcode::kFooter;
  place_ = record->end();
  return record;
}

}  // namespace railcast::mcap
