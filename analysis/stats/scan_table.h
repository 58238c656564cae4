#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/frame/frame.h"
#include "core/scan/scan_pattern.h"

namespace railcast {

/// Where each firing of a grid looks, also those without a point.
///
/// A row has one elevation; a column has one azimuth, to which the row adds an offset of its own
/// (spinning sensors' channels look beside each other and fire one after another).
struct ScanTable {
  std::uint32_t rows{};
  std::uint32_t columns{};
  std::vector<double> elevation_rad;       ///< Of each row, up positive; NaN = not known.
  std::vector<double> row_azimuth_rad;     ///< Of each row, added to the column's.
  std::vector<double> column_azimuth_rad;  ///< Left positive, unwrapped; NaN = not known.
  double column_step_rad{};                ///< Median distance of neighbouring columns, > 0.
  std::vector<double> row_height_rad;      ///< Elevation that a row stands for.

  /// Unit vector in the sensor's axes; NaN where it is not known.
  [[nodiscard]] std::array<double, 3> Direction(std::size_t row, std::size_t column) const;
  /// Solid angle that one firing of this row stands for.
  [[nodiscard]] double SolidAngle_sr(std::size_t row) const;
};

/// From the points' directions: medians over rows and columns, gaps filled in between by straight
/// lines. Nothing if the frame is no grid of at least 2 x 2 with points.
/// @pre Slots of `frame` are firings.
[[nodiscard]] std::optional<ScanTable> MakeScanTable(const Frame& frame);

/// From the firings of a pattern; nothing if it is no grid.
[[nodiscard]] std::optional<ScanTable> MakeScanTable(const ScanPattern& pattern);

}  // namespace railcast
