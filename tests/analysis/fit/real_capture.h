#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "core/io/pcap/pcap_reader.h"
#include "core/io/recording/turn_frame.h"
#include "core/io/velodyne/velodyne_decoder.h"
#include "core/io/velodyne/velodyne_model.h"
#include "tests/support/sensor_file.h"

namespace railcast {

inline const std::filesystem::path kVls128Capture =
    RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula/vls128_single.pcap";

/// Reads a capture of a real VLS-128 standing by a road; ranges to 238 m. No railcast program reads
/// its packets, but the decoder accepts them once the flags of the third and the fourth block of a
/// cycle are replaced by those of the first.
/// @returns The complete turns.
[[nodiscard]] inline std::vector<RecordedFrame> ReadVls128() {
  constexpr std::uint8_t kVls128 = 0xA1;
  constexpr std::size_t kWholeTurn = 1800;
  const auto spinning = std::get<SpinningSpec>(ReadSensor("vls128").pattern);
  const VelodyneModel model{.name = "VLS-128",
                            .id = kVls128,
                            .has_mode_and_id = true,
                            .has_own_angles = false,
                            .distance_unit_m = 0.004,
                            .cycle_us = spinning.cycle_us,
                            .lasers = spinning.channels};
  VelodyneDecoder decoder(model);
  std::vector<SensorTurn> turns;
  PcapReader reader(kVls128Capture);
  while (const auto datagram = reader.Next()) {
    std::vector<char> packet(datagram->payload.begin(), datagram->payload.end());
    if (packet.size() != kVelodynePacketSize) continue;
    for (std::size_t block = 0; block < kBlocksPerPacket; ++block) {
      if (block % model.blocks_per_cycle() < 2) continue;
      std::memcpy(packet.data() + block * kBlockSize, &kLowerBlockFlag, sizeof kLowerBlockFlag);
    }
    if (const auto refusal = decoder.Decode(packet, turns)) throw std::runtime_error(*refusal);
  }
  const TurnShape shape = ShapeOfTurns(model.lasers, IntensityBytes::kVelodyne);
  std::vector<RecordedFrame> frames;
  for (const SensorTurn& turn : turns) {
    if (turn.num_columns() < kWholeTurn) continue;
    frames.push_back(MakeTurnFrame(turn, shape, "turn " + std::to_string(frames.size())));
    frames.back().frame.index = static_cast<std::uint32_t>(frames.size());
  }
  return frames;
}

}  // namespace railcast
