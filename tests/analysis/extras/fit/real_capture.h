#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

#include "railcast/io/recording.h"

namespace railcast {

inline const std::filesystem::path kVls128Capture =
    RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula/vls128_single.pcap";

/// Reads the capture of a real VLS-128 standing by a road; ranges to 238 m.
/// @returns The complete turns.
[[nodiscard]] inline std::vector<RecordedFrame> ReadVls128() {
  constexpr std::size_t kWholeTurn = 1800;
  const auto recording = OpenRecording(kVls128Capture);
  std::vector<RecordedFrame> frames;
  while (const auto read = recording->Next()) {
    RecordedFrame recorded = (*read)();
    if (recorded.frame.columns < kWholeTurn) continue;
    frames.push_back(std::move(recorded));
    frames.back().frame.index = static_cast<std::uint32_t>(frames.size());
  }
  return frames;
}

}  // namespace railcast
