#pragma once

#include "core/io/recording/scan_table.h"
#include "viewer/overlays/drawing.h"

namespace railcast {

/// A frustum of more is out of sight and hides what is in it.
inline constexpr double kMostFrustumRange_m = 100.0;

/// The outline of what a sensor scans, in its axes, out to `range_m` or 100 m, whichever is less.
///
/// Of a part of a turn: rays along its four corners, and at their ends the border: the top and
/// bottom rows and the first and last columns. Of a full turn: the circles of the top and bottom
/// rows with eight rays each. Chords go from beam to beam. A table made from a frame does not know
/// rows and columns at its ends in which nothing came back (the sky): then the outermost that it
/// knows count.
/// @param table MakeScanTable() of the scenario's pattern, or of a frame where there is none.
[[nodiscard]] Drawing DrawSensorFrustum(const ScanTable& table, double range_m);

}  // namespace railcast
