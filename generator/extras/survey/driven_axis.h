#pragma once

#include <optional>
#include <vector>

#include "railcast/alignment.h"
#include "railcast/transform.h"

namespace railcast {

/// Where a vehicle was, frame by frame.
struct DrivenWay {
  std::vector<Transform> world_from_body;  ///< In the order of frames.
  /// By how much the body's origin is above top of rail; 0 for the vehicle's own.
  double above_rail_m = 0.0;
};

/// A line along the way: a spline through the places in plan, with gradients through the heights,
/// that goes on straight at both ends. A vehicle that stood gets a straight line. Nothing if the
/// way turns back, as where recordings are not in the order in which the way goes through them.
/// @param beyond_m How far the line goes on.
[[nodiscard]] std::optional<AlignmentSpec> AxisAlong(const DrivenWay& way, double beyond_m);

}  // namespace railcast
