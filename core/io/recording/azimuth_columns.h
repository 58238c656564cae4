#pragma once

#include <cstdint>
#include <vector>

namespace railcast {

/// A point while the table is made.
struct TablePoint {
  std::uint32_t index{};  ///< In the file.
  std::uint32_t row{};
  double turns{};  ///< Azimuth in the sense of rotation, in [0, 1).
  double range_m{};
  std::int64_t column{};
};

/// The usual step from neighbour to neighbour of a row, in turns, made exact over ever longer ways
/// along the rows; 0 if there are no neighbours. @pre Sorted by row and azimuth.
[[nodiscard]] double AzimuthStepOf(const std::vector<TablePoint>& points);

/// Gives every point its column, azimuth / step, rounded so that no two firings of a row share one:
/// with i the number of the firing in its row, azimuth / step - i may not fall, and is fitted by
/// least squares under that rule. Points of nearly the same azimuth are of one firing.
/// @pre Sorted by row and azimuth; step > 0.
void AssignColumns(std::vector<TablePoint>& points, double step);

}  // namespace railcast
