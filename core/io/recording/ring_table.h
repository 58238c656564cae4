#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/io/recording/cloud_fields.h"

namespace railcast {

inline constexpr std::size_t kMaxRings = 256;

/// Returns the ring of each point by its elevation, 0 the lowest. Nothing is returned unless the
/// elevations lie in 2 to kMaxRings clusters that hold 98 % of the points and of which none is
/// wider than half its distance to the next. The remaining points belong to the nearest cluster.
[[nodiscard]] std::optional<std::vector<std::uint32_t>> RingsByElevation(
    std::span<const double> elevations_rad);

/// A point while its table is being made.
struct TablePoint {
  std::uint32_t index{};  ///< Index in the file.
  std::uint32_t row{};
  double turns{};  ///< Azimuth in the sense of rotation, in turns, in [0, 1).
  double range_m{};
  std::int64_t column{};
};

/// Returns the usual azimuth step between neighbours of a row, in turns, refined over ever longer
/// distances along the rows; 0 if there are no neighbours.
/// @pre Sorted by row and azimuth.
[[nodiscard]] double AzimuthStepOf(const std::vector<TablePoint>& points);

/// Gives every point its column, azimuth / step, rounded so that no two firings of a row share one.
/// For firing number i of a row, azimuth / step - i must not fall from firing to firing; it is
/// fitted by least squares under that constraint and rounded. Points of nearly the same azimuth
/// belong to one firing.
/// @pre Sorted by row and azimuth; step > 0.
void AssignColumns(std::vector<TablePoint>& points, double step);

/// Positions of points, in arrays of equal length. Entries that are not finite, or all 0, are not
/// points.
struct PointPositions {
  std::vector<float> x, y, z;  ///< In m, with z up.

  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] bool IsPoint(std::size_t i) const;
};

/// Puts the points of a spinning sensor into a ring/azimuth table where no file states their
/// firings.
///
/// Rows are the rings by rising median elevation. The step from column to column is the usual one
/// between neighbours of a ring, refined over ever longer distances along the rings. A point's
/// column is azimuth / step, rounded so that no two firings of a ring share one (AssignColumns()).
/// Plain rounding would leave holes that are not dropouts, because the rotor's speed varies and
/// decoders interpolate the azimuth differently. Columns rise with time, in the sense in which most
/// neighbours of a ring follow each other in the file, or clockwise if neither sense prevails. They
/// start behind the widest gap in azimuth, or at the file's first point if the turn is full.
///
/// Firings that returned nothing to any ring are not part of the table: columns without any point
/// are left out, so that the table covers just the azimuths seen, and so are rings without points.
/// Where lasers have azimuth offsets of their own (VLP-32C, up to 4.2 deg), rings begin and end at
/// different azimuths in a partial turn.
///
/// A cell with several points has as many returns, the nearest first.
///
/// @param rings Ring of each point, as any numbers. If empty, rings are found from the elevations,
///   provided that these lie in 2 to 256 narrow clusters that hold 98 % of the points.
/// @returns Nothing if there are no such clusters, if a cell has more than four points, or if the
///   table would be nearly empty.
[[nodiscard]] std::optional<SlotPlan> MakeRingTable(const PointPositions& positions,
                                                    std::span<const std::uint32_t> rings);

}  // namespace railcast
