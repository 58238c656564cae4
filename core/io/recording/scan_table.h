#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "railcast/frame.h"
#include "railcast/lidar.h"
#include "railcast/transform.h"

namespace railcast {

/// Returns the same angle wrapped to -pi to pi.
[[nodiscard]] inline double WrappedAngle_rad(double angle_rad) {
  return std::remainder(angle_rad, 2.0 * std::numbers::pi);
}

/// The direction of each firing of a grid, including firings without a point.
///
/// Each row has one elevation; each column has one azimuth, to which the row adds an offset of its
/// own, since the channels of a spinning sensor differ in azimuth and fire one after another.
struct ScanTable {
  std::uint32_t rows{};
  std::uint32_t columns{};
  std::vector<double> elevation_rad;       ///< For each row, positive upward; NaN = unknown.
  std::vector<double> row_azimuth_rad;     ///< Offset of each row, added to the column's azimuth.
  std::vector<double> column_azimuth_rad;  ///< Positive to the left, unwrapped; NaN = unknown.
  double column_step_rad{};                ///< Median distance between neighbouring columns, > 0.
  bool is_full_turn{};                     ///< Whether the last column adjoins the first.
  std::vector<std::int64_t> row_shift;     ///< Offset of each row in columns; see ColumnBeside().
  std::vector<double> row_height_rad;      ///< Elevation range that each row covers; NaN = unknown.
  double row_step_rad{};                   ///< Median of row_height_rad, > 0.
  /// As in Frame: elevations and azimuths are those in the axes about whose z the sensor spins.
  std::optional<Eigen::Matrix3d> sensor_from_spin;

  /// Returns the column in which `other_row` has the azimuth of (row, column), to half a column:
  /// the rows of spinning sensors differ by degrees in azimuth. Returns nothing beyond the ends of
  /// a partial turn.
  [[nodiscard]] std::optional<std::size_t> ColumnBeside(std::size_t row,
                                                        std::size_t column,
                                                        std::size_t other_row) const {
    const auto num = static_cast<std::int64_t>(columns);
    std::int64_t beside = static_cast<std::int64_t>(column) + row_shift[row] - row_shift[other_row];
    if (is_full_turn) beside = ((beside % num) + num) % num;
    if (beside < 0 || beside >= num) return std::nullopt;
    return static_cast<std::size_t>(beside);
  }
  /// Returns the unit vector in the sensor's axes; NaN where the direction is unknown.
  [[nodiscard]] std::array<double, 3> Direction(std::size_t row, std::size_t column) const;
  /// Returns the solid angle that one firing of this row covers.
  [[nodiscard]] double SolidAngle_sr(std::size_t row) const;
};

/// The point of a slot in the axes about whose z the sensor spins (Frame::sensor_from_spin).
[[nodiscard]] Vector3 SpinPoint_m(const Frame& frame, std::size_t slot);

/// A point as its beam sees it, from where it leaves.
struct AimedPoint {
  double azimuth_rad{};  ///< Azimuth of the beam.
  double elevation_rad{};
};

/// Returns the point of a slot as its beam sees it. Beams leave `origin_m[0]` outwards of the axis,
/// at the rotor's azimuth, and `origin_m[1]` above the origin.
/// @param channel_azimuth_rad Of the beam, added to the rotor's; positive to the left.
[[nodiscard]] AimedPoint SeenFromBeam(const std::array<double, 2>& origin_m,
                                      double channel_azimuth_rad,
                                      const Frame& frame,
                                      std::size_t slot);

/// Makes the table from the points' directions: medians over rows and columns, with linear
/// interpolation across gaps. Returns nothing if the frame is not a grid of at least 2 x 2 with
/// points: the elevations within the rows of a grid differ by less than two steps between rows.
/// @param origin_m Where beams leave, as SpinningSpec::beam_origin_m; directions count from there.
/// @param aside_rad For each row, the azimuth of its beams beside the rotor's, positive to the
///   left, as far as it matters for where they leave; empty = 0.
/// @pre The slots of `frame` are firings.
[[nodiscard]] std::optional<ScanTable> MakeScanTable(const Frame& frame,
                                                     const std::array<double, 2>& origin_m = {},
                                                     std::span<const double> aside_rad = {});

/// Makes the table from the firings of a pattern; returns nothing if that is not a grid, or differs
/// from frame to frame.
[[nodiscard]] std::optional<ScanTable> MakeScanTable(const ScanPattern& pattern);

}  // namespace railcast
