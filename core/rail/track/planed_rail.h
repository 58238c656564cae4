#pragma once

#include <limits>
#include <span>

#include "core/rail/line/rail_section.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// A place along a rail that is swept: where the track's frame lies, and how much of the rail is
/// left of what planing took from its back.
struct RailStation {
  Transform mesh_from_track = Transform::Identity();
  /// Width from the gauge face outwards, over the whole height; infinite = the whole rail.
  double width_m = std::numeric_limits<double>::infinity();
};

/// The running band of a rail and all the rest of its surface.
struct RailMeshes {
  Mesh band;
  Mesh rest;
};

/// The section of the left or right rail, of which nothing is farther than `width_m` behind the
/// gauge face. A blade that is planed to less than half its head is therefore lower, too. Points
/// keep their number and order, so that sections of different widths can be joined.
[[nodiscard]] RailSection PlanedSection(bool left, double width_m);

/// Sweeps the left or right rail along stations in rising chainage.
[[nodiscard]] RailMeshes SweepRail(bool left, std::span<const RailStation> stations);

/// Closes a rail at a station where it begins or ends.
void AppendRailEnd(const RailStation& station, bool left, bool faces_ahead, Mesh& mesh);

}  // namespace railcast
