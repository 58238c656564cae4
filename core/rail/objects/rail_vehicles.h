#pragma once

#include "core/rail/base/rail_surfaces.h"
#include "railcast/scene.h"
#include "railcast/world_spec.h"

namespace railcast {

/// Main dimensions of a rail vehicle, as its data sheet has them (docs/things.md, "Rail vehicles").
struct RailVehicleMeasures {
  double length_m{};          ///< Over buffers or couplers.
  double pivot_distance_m{};  ///< Between the pivots of the two bogies.
  double width_m{};
  double height_m{};  ///< Above top of rail; with a raised pantograph, that of its contact strip.
};

/// Whether any vehicle of the world or of the sensor's own train has VehicleSurfaces.
[[nodiscard]] bool HasVehicleSurfaces(const WorldSpec& world, const VehicleSpec& vehicle);

/// @pre IsRailVehicle(type).
[[nodiscard]] const RailVehicleMeasures& MeasuresOf(ObjectType type);

/// A rail vehicle in the two kinds of pieces that turn against each other in a curve. Frames: x
/// forward, y left, z up from top of rail; metres.
struct RailVehicleModel {
  Model body;   ///< The origin is midway between the pivots.
  Model bogie;  ///< Both bogies; the origin is in the pivot's axis.
};

/// The geometry of a rail vehicle. Its length over buffers or couplers is centred on the origin,
/// which is midway between the pivots. The wheels touch z = 0, and only their flanges are below.
/// @pre IsRailVehicle(type).
[[nodiscard]] RailVehicleModel MakeRailVehicle(ObjectType type, const RailSurfaces& surfaces);

/// The whole vehicle on straight track: the body with its bogies half of `pivot_distance_m` before
/// and behind the middle.
[[nodiscard]] Model WholeOf(const RailVehicleModel& vehicle, double pivot_distance_m);

}  // namespace railcast
