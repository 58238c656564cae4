#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/io/hesai/pandar64_decoder.h"
#include "core/io/hesai/pandar64_packet.h"
#include "core/io/recording/recording_kinds.h"

namespace railcast {
namespace {

void CheckTurn(const SensorTurn& turn) {
  Check(turn.num_columns() <= (std::size_t{1} << 14U) + 6, "a turn has an end");
  for (const TurnPoint& point : turn.points) {
    Check(point.column < turn.num_columns() && point.ring < 64 && point.return_index < 2,
          "a point is of a firing");
    Check(turn.is_dual || point.return_index == 0, "a second return is of dual mode");
    Check(point.range_m > 0.0F && point.range_m < 16'712.0F, "a range is within the format");
    Check(std::isfinite(point.x + point.y + point.z), "a point is somewhere");
  }
}

// Splits the bytes into packets; the last one may be truncated.
void DecodePackets(std::span<const char> bytes) {
  Pandar64Decoder decoder;
  std::vector<SensorTurn> turns;
  while (!bytes.empty()) {
    const auto packet = bytes.first(std::min(bytes.size(), kPandar64PacketSize));
    (void)decoder.Decode(packet, turns);
    bytes = bytes.subspan(packet.size());
  }
  turns.push_back(decoder.TakeUnfinished());
  std::ranges::for_each(turns, CheckTurn);
}

void CheckFrame(const RecordedFrame& recorded) {
  const Frame& frame = recorded.frame;
  Check(recorded.is_grid && frame.columns > 0, "a turn is a grid");
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    Check(frame.ring[i] == i / frame.width(), "a slot knows its place");
    Check(std::isnan(frame.x[i]) == std::isnan(frame.intensity[i]), "a point has an intensity");
    Check(frame.return_count[i] <= frame.returns, "returns are counted");
  }
}

void ReadCapture(std::span<const char> bytes) {
  const auto open = [&] {
    std::FILE* const stream =
        // Mode "r" does not write.
        ::fmemopen(const_cast<char*>(bytes.data()), bytes.size(), "rb");
    if (stream == nullptr) throw InputError("fuzz: empty");
    return stream;
  };
  try {
    const auto recording = OpenCapture(open, "fuzz");
    while (const auto read = recording->Next()) CheckFrame((*read)());
  } catch (const InputError& error) {
    Check(std::string(error.what()).starts_with("fuzz: "), "a fault names its file");
  }
}

}  // namespace
}  // namespace railcast

/// Entry point for libFuzzer. The first byte selects the format of the rest: h for packets of a
/// Pandar64, anything else for a capture.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] == 'h') {
    railcast::DecodePackets(bytes);
  } else {
    railcast::ReadCapture(bytes);
  }
  return 0;
}
