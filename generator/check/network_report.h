#pragma once

#include <optional>
#include <string>

#include "generator/check/vehicle_way.h"
#include "railcast/rail_world.h"

namespace railcast {

/// The tracks of a world with more than one: name, length, chainages and tightest radius of each,
/// the turnouts that lie in it, and the tracks that it crosses.
[[nodiscard]] std::string NetworkText(const RailWorld& world);

/// Name of the track on which the vehicle starts.
[[nodiscard]] std::string StartTrack(const RailWorld& world, const VehicleSpec& vehicle);

/// The largest lateral acceleration of the vehicle on its way, in the plane of the rails: v^2 times
/// the curvature of the track, less the part of gravity that the cant balances.
struct LateralPeak {
  double acceleration_mps2{};  ///< Towards the outside of the curve.
  double balanced_mps2{};      ///< What the cant takes from it.
  WayPoint point;
};

/// Samples the way from its start to its end or, where it has none, for an hour after the end of
/// the speed profile. Returns nothing if it stands or if cant balances every curve.
[[nodiscard]] std::optional<LateralPeak> FindLateralPeak(const RailWorld& world,
                                                         const VehicleSpec& vehicle,
                                                         const VehicleWay& way);

/// The route, if it has several tracks, and the peak.
[[nodiscard]] std::string RouteText(const RailWorld& world, const std::optional<LateralPeak>& peak);

}  // namespace railcast
