#pragma once

#include "railcast/alignment.h"
#include "railcast/transform.h"

namespace railcast {

/// A place in the world as seen from the alignment.
struct PlaceBesideLine {
  double s_m{};  ///< Chainage of the axis point beside which it lies in plan.
  double d_m{};  ///< Left of that point, horizontally.
  double h_m{};  ///< Above it, vertically.
};

/// Finds a place in the world by steps along the line, to 1 um of chainage where they converge:
/// from a chainage that is nearer than the centre of a curve.
[[nodiscard]] PlaceBesideLine PlaceOnLine(const Alignment& alignment,
                                          const Vector3& place_world_m,
                                          double near_s_m);

}  // namespace railcast
