#pragma once

#include "core/rail/base/rail_surfaces.h"
#include "railcast/scene.h"

namespace railcast {

/// Dimensions of a bogie of a locomotive or passenger vehicle.
struct TrainBogieShape {
  double axle_base_m{};
  double wheel_radius_m{};  ///< At the tape circle.
  double top_m{};           ///< Where the body rests, above top of rail.
  bool has_motors = false;  ///< Whether traction motors hang between the axles.
  bool has_shoes = false;   ///< Whether it has collectors for a third rail.
};

/// A bogie with outside frame, two stages of springs and disc brakes, about its pivot. Frame as in
/// wagon_parts.h.
[[nodiscard]] Model MakeTrainBogie(const TrainBogieShape& shape, const RailSurfaces& surfaces);

}  // namespace railcast
