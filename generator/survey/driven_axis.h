#pragma once

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
/// that goes on straight at both ends. A vehicle that stood gets a straight line.
/// @param beyond_m How far the line goes on.
[[nodiscard]] AlignmentSpec AxisAlong(const DrivenWay& way, double beyond_m);

}  // namespace railcast
