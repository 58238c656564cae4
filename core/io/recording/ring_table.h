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
/// between neighbours of a ring, made exact over ever longer ways along the rings. A point's column
/// is azimuth / step, rounded so that no two firings of a ring share one: with i the number of the
/// firing in its ring, azimuth / step - i may not fall, and is fitted by least squares under that
/// rule. Plain rounding would leave holes that are no dropouts, for a rotor's speed and what
/// decoders make of it vary. Columns rise with time: in the sense in which most neighbours of a
/// ring follow each other in the file, clockwise if none does, from behind the widest gap in
/// azimuth, or from the file's first point if it is a whole turn.
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
