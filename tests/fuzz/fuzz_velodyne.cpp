#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/extras/packets/pcap/pcap_reader.h"
#include "core/extras/packets/spinning/spinning_decoder.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/decode_packet.h"

namespace railcast {
namespace {

constexpr std::array<std::string_view, 5> kNames = {"VLP-16", "HDL-32E", "VLP-32C", "HDL-64E",
                                                    "VLS-128"};

void CheckVelodyneTurn(const SensorTurn& turn) {
  Check(turn.num_columns() <= (std::size_t{1} << 14U) + 1, "a turn has an end");
  for (const TurnPoint& point : turn.points) {
    Check(point.range_m > 0.0F && point.range_m < 263.0F, "a range is within the format");
    Check(point.azimuth_rad >= 0.0F && point.azimuth_rad < 6.2832F, "an azimuth is of one turn");
    Check(std::isfinite(point.x + point.y + point.z), "a point is somewhere");
    Check(point.column < turn.num_columns(), "a point is of a firing cycle");
    Check(point.laser < 128 && point.ring < 128 && point.return_index < 2, "a laser is one of 128");
  }
}

// Splits the bytes into packets; the last one may be truncated.
void DecodePackets(std::string_view name, std::span<const char> bytes) {
  const SpinningModel& model = ModelNamed(name);
  SpinningDecoder decoder(model);
  std::vector<SensorTurn> turns;
  while (!bytes.empty()) {
    const auto packet = bytes.first(std::min(bytes.size(), model.packet_size));
    (void)DecodePacket(decoder, packet, turns);
    bytes = bytes.subspan(packet.size());
  }
  turns.push_back(decoder.TakeUnfinished());
  std::ranges::for_each(turns, CheckVelodyneTurn);
}

void ReadVelodyneCapture(std::span<const char> bytes) {
  std::FILE* const stream =
      ::fmemopen(const_cast<char*>(bytes.data()), bytes.size(), "rb");  // Mode "r" does not write.
  if (stream == nullptr) return;
  std::vector<SpinningDecoder> decoders;
  for (const std::string_view name : kNames) decoders.emplace_back(ModelNamed(name));
  std::vector<SensorTurn> turns;
  try {
    PcapReader reader(stream, "fuzz");
    while (const auto datagram = reader.Next()) {
      for (SpinningDecoder& decoder : decoders) {
        (void)DecodePacket(decoder, datagram->payload, turns);
      }
    }
  } catch (const InputError&) {
  }
  std::ranges::for_each(turns, CheckVelodyneTurn);
}

}  // namespace
}  // namespace railcast

/// Entry point for libFuzzer. The first byte selects the format of the rest: 0 to 4 for packets of
/// a model, anything else for a capture.
RAILCAST_FUZZ_TARGET(velodyne) {
  if (size == 0) return 0;
  const std::span bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] >= '0' && data[0] <= '4') {
    railcast::DecodePackets(railcast::kNames.at(data[0] - std::size_t{'0'}), bytes);
  } else {
    railcast::ReadVelodyneCapture(bytes);
  }
  return 0;
}
