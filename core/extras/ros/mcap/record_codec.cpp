#include "core/extras/ros/mcap/record_codec.h"

#include <zlib.h>

namespace railcast::mcap {

std::uint32_t Crc32(ByteSpan bytes, std::uint32_t before) {
  return static_cast<std::uint32_t>(
      ::crc32_z(before, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

std::optional<RecordView> RecordCursor::Next() {
  if (place_ == bytes_.size()) return std::nullopt;
  return AtPlace("record at " + NumberText(place_) + ": ", [&] {
    FieldReader read(bytes_.subspan(place_));
    RecordView view{.opcode = {}, .offset = place_, .content = {}};
    std::uint8_t opcode{};
    CountedBytes content;
    read("opcode", opcode);
    read("content", content);
    view.opcode = static_cast<McapOpcode>(opcode);
    view.content = content.bytes;
    place_ += kRecordHead_bytes + content.bytes.size();
    return std::optional(view);
  });
}

}  // namespace railcast::mcap
