#pragma once

#include "railcast/objects.h"
#include "railcast/scene.h"
#include "railcast/world_spec.h"

namespace railcast {

/// Main dimensions of a rail vehicle, as its table of models has them.
struct RailVehicleMeasures {
  double length_m{};          ///< Over buffers or couplers.
  double pivot_distance_m{};  ///< Between the pivots of the two bogies.
  double width_m{};
  double height_m{};  ///< Above top of rail; with a raised pantograph, that of its contact strip.
};

/// @pre IsRailVehicle(type).
[[nodiscard]] RailVehicleMeasures MeasuresOf(const ObjectType& type);

/// The whole vehicle on straight track: the body with its bogies half of `pivot_distance_m` before
/// and behind the middle.
[[nodiscard]] Model WholeOf(const Model& body, const Model& bogie, double pivot_distance_m);

}  // namespace railcast
