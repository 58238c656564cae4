#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/io/hesai/hesai_decoder.h"
#include "core/io/recording/recording_kinds.h"

namespace railcast {
namespace {

void CheckTurn(const SensorTurn& turn, std::size_t num_rings) {
  Check(turn.num_columns() <= (std::size_t{1} << 14U) + 6, "a turn has an end");
  for (const TurnPoint& point : turn.points) {
    Check(point.column < turn.num_columns() && point.ring < num_rings && point.return_index < 2,
          "a point is of a firing");
    Check(turn.is_dual || point.return_index == 0, "a second return is of dual mode");
    Check(point.range_m > 0.0F && point.range_m < 16'712.0F, "a range is within the format");
    Check(std::isfinite(point.x + point.y + point.z), "a point is somewhere");
  }
}

// Splits the bytes into packets; the last one may be truncated.
void DecodePackets(const HesaiModel& model, std::span<const char> bytes) {
  HesaiDecoder decoder(model);
  std::vector<SensorTurn> turns;
  while (!bytes.empty()) {
    const auto packet = bytes.first(std::min(bytes.size(), model.layout.packet_size));
    (void)decoder.Decode(packet, turns);
    bytes = bytes.subspan(packet.size());
  }
  turns.push_back(decoder.TakeUnfinished());
  for (const SensorTurn& turn : turns) CheckTurn(turn, model.channels.size());
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
/// Pandar64, x of an XT32, q of a QT128, anything else for a capture.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0]) {
    case 'h':
      railcast::DecodePackets(railcast::Pandar64Model(), bytes);
      break;
    case 'x':
      railcast::DecodePackets(railcast::Xt32Model(), bytes);
      break;
    case 'q':
      railcast::DecodePackets(railcast::Qt128Model(), bytes);
      break;
    default:
      railcast::ReadCapture(bytes);
  }
  return 0;
}
