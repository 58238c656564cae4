#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "core/frame/frame.h"
#include "core/scan/scan_pattern.h"

namespace railcast {

/// The same direction between -pi and pi.
[[nodiscard]] inline double WrappedAngle_rad(double angle_rad) {
  return std::remainder(angle_rad, 2.0 * std::numbers::pi);
}

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
  bool is_full_turn{};                     ///< Whether the first column is beside the last.
  std::vector<std::int64_t> row_shift;     ///< Of each row, in columns; see ColumnBeside().
  std::vector<double> row_height_rad;      ///< Elevation that a row stands for; NaN = not known.
  double row_step_rad{};                   ///< Their median, > 0.

  /// The column in which `other_row` looks into the azimuth of (row, column), to half a column:
  /// rows of spinning sensors look degrees beside each other. Nothing beyond the ends.
  [[nodiscard]] std::optional<std::size_t> ColumnBeside(std::size_t row,
                                                        std::size_t column,
                                                        std::size_t other_row) const {
    const auto num = static_cast<std::int64_t>(columns);
    std::int64_t beside = static_cast<std::int64_t>(column) + row_shift[row] - row_shift[other_row];
    if (is_full_turn) beside = ((beside % num) + num) % num;
    if (beside < 0 || beside >= num) return std::nullopt;
    return static_cast<std::size_t>(beside);
  }
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
