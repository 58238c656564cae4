#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "railcast/lidar.h"

namespace railcast {

/// A firing whose direction is known beforehand, such as a recorded one.
struct GivenFiring {
  std::array<float, 3> direction{};  ///< Unit vector in the sensor's axes.
  std::array<float, 3> origin_m{};   ///< Where the beam leaves, in the sensor's axes.
  std::uint32_t time_ns{};           ///< Since the stamp.
  std::uint16_t row{};
  std::uint32_t column{};
};

/// Makes the pattern of one frame of given firings, in any order, whose stamp is that of frame 0 of
/// the pattern. Packets are runs of a row's firings, which costs no sorting by angle.
/// @param shape The pattern that gives rate_hz, rows and columns.
[[nodiscard]] ScanPattern PatternOfFirings(const ScanPattern& shape,
                                           std::vector<GivenFiring> firings);

}  // namespace railcast
