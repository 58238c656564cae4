#pragma once

#include <cmath>
#include <utility>

#include "railcast/rail_world.h"
#include "railcast/transform.h"

namespace railcast {

/// The world with a track "second" 8 m left of the line, and without plants and wires, which would
/// hide what stands there.
[[nodiscard]] inline WorldSpec BareWithSecondTrack(WorldSpec world) {
  TrackSpec second{.name = "second", .offset_m = 8.0};
  world.tracks.push_back(std::move(second));
  world.catenary.enabled = false;
  world.vegetation.trees_per_hectare = 0.0;
  world.vegetation.grass = false;
  return world;
}

/// The mount, above the vehicle's origin, of a sensor that looks at a point.
/// @param point In the vehicle's frame.
[[nodiscard]] inline Transform VehicleFromSensorAimedAt(const Vector3& point, double above_m) {
  const Vector3 place(0.0, 0.0, above_m);
  const Vector3 toward_m = point - place;
  return MakeTransform(
      RotationFromYawPitchRoll(std::atan2(toward_m.y(), toward_m.x()),
                               -std::atan2(toward_m.z(), toward_m.head<2>().norm()), 0.0),
      place);
}

}  // namespace railcast
