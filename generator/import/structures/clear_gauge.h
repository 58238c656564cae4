#pragma once

#include "generator/import/network/line_world.h"
#include "railcast/alignment.h"

namespace railcast {

/// Leaves out what `railcast-generate check` would have something against, and says so: structures
/// that break a rule of worlds (CheckStructures), and those that stand in the structure gauge of a
/// track (FindStructuresInGauge). What runs along a track is cut there instead, and portals that
/// stand in a gauge are left out alone.
/// @param alignment Complete, with heights and cants.
void ClearStructures(const AlignmentSpec& alignment, LineWorld& world);

}  // namespace railcast
