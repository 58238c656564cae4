#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "railcast/io/recording.h"
#include "railcast/lidar.h"

namespace railcast {

/// Direction and time of each firing of a grid, including those without a return, at row * columns
/// + column.
struct Beams {
  std::uint32_t rows{};
  std::uint32_t columns{};
  /// Unit vectors in the sensor's axes at the firing; NaN where unknown.
  std::vector<Eigen::Vector3f> directions;
  std::vector<std::uint32_t> times_ns;  ///< Time since the stamp.
};

/// Takes the beams exactly from the scenario's pattern.
[[nodiscard]] Beams BeamsOf(const ScanPattern& pattern);

/// Estimates the directions from the frame's own points (MakeScanTable()) and takes its times.
/// Empty if its slots are not firings, or not a grid of at least 2 x 2 with points.
[[nodiscard]] std::optional<Beams> BeamsOf(const RecordedFrame& recorded);

}  // namespace railcast
