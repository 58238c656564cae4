#pragma once

#include "railcast/world_spec.h"

namespace railcast {

/// The axes of a turnout with a straight main track. The diverging axis is an arc that touches the
/// main axis at the turnout's beginning and turns by the angle; then it runs straight to the
/// turnout's end. Both axes are equally long from the point where their tangents meet to the end.
struct TurnoutGeometry {
  double radius_m{};   ///< Of the arc of the diverging axis.
  double angle_rad{};  ///< atan(1 / n) for a turnout 1:n.
  /// From the beginning to the point where the tangents meet: R tan(angle / 2).
  double tangent_m{};
  double length_m{};  ///< From the beginning to the end, along the main axis.

  /// Length of the arc of the diverging axis.
  [[nodiscard]] double arc_m() const { return radius_m * angle_rad; }
  /// Length of the straight behind the arc.
  [[nodiscard]] double straight_m() const { return length_m - 2.0 * tangent_m; }
};

/// The standard turnouts of docs/world.md: 1:9-300, 1:12-500 and 1:14-760 end where the arc
/// does. The arc of 1:9-190 ends before its crossing, and it is as long behind the point where the
/// tangents meet as a 1:9-300, whose crossing it shares.
[[nodiscard]] TurnoutGeometry GeometryOf(TurnoutType type);

}  // namespace railcast
