#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/io/recording/cloud_fields.h"

namespace railcast {

/// Positions of points, all of one length; those that are not finite, or all 0, are no points.
struct PointPositions {
  std::vector<float> x, y, z;  ///< m, z up.

  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] bool IsPoint(std::size_t i) const;
};

/// Puts a spinning sensor's points, of which no file says the firing, into a ring/azimuth table.
///
/// Rows are the rings by rising median elevation. The step from column to column is the usual one
/// between neighbours of a ring: the mean of those within 50 % of the lower quartile. In each ring
/// a point's column is its neighbour's plus the steps between them, set right where that strays
/// more than one column from azimuth / step: a rotor's speed varies a little, and plain rounding
/// would leave holes that are no dropouts. Columns rise with time: in the sense in which most
/// neighbours of a ring follow each other in the file, clockwise if none does, from behind the
/// widest gap in azimuth.
///
/// What nobody saw is no firing: columns without any point are left out, so that the table covers
/// the azimuths seen and no more, and so are rings without points. Where lasers have azimuths of
/// their own (VLP-32C, up to 4.2 deg) the ends of a partial turn are not the same for all.
///
/// A cell with two points has two returns, the nearer first, if such points are 2 % or more of all;
/// otherwise they are rounding's, and the nearer stays alone.
///
/// @param rings Of each point, any numbers. Empty: rings are found in the elevations, if these lie
///   in 2 to 256 narrow clusters that hold 98 % of the points.
/// @returns Nothing if there are no such clusters, or the table would be nearly empty.
[[nodiscard]] std::optional<SlotPlan> MakeRingTable(const PointPositions& positions,
                                                    std::span<const std::uint32_t> rings);

}  // namespace railcast
