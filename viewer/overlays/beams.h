#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/io/recording/recording.h"
#include "core/scan/scan_pattern.h"

namespace railcast {

/// Where and when each firing of a grid looks, also those that brought nothing back. At
/// row * columns + column.
struct Beams {
  std::uint32_t rows{};
  std::uint32_t columns{};
  std::vector<Eigen::Vector3f> directions;  ///< Unit, the sensor's axes at the firing; NaN = not
                                            ///< known.
  std::vector<std::uint32_t> times_ns;      ///< Since the stamp.
};

/// Exactly, from the scenario's pattern.
[[nodiscard]] Beams BeamsOf(const ScanPattern& pattern);

/// As far as the frame's own points show it (MakeScanTable()), with its own times. Nothing if its
/// slots are no firings, or no grid of at least 2 x 2 with points.
[[nodiscard]] std::optional<Beams> BeamsOf(const RecordedFrame& recorded);

}  // namespace railcast
