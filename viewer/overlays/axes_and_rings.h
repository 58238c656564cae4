#pragma once

#include <optional>

#include "core/scenario/scenario_spec.h"
#include "viewer/overlays/drawing.h"

namespace railcast {

/// The sensor's axes, 2 m long each, with their letters: x vermillion, y bluish green, z blue,
/// which is red, green and blue for everybody.
[[nodiscard]] Drawing DrawAxes();

/// Circles of 10, 25, 50, 100, 150, 200 and 300 m about the sensor, up to `limit_m`, each within 1
/// cm of its circle, with their radius ("50 m") straight ahead and behind.
/// @param mount Where the sensor sits on its vehicle, if that is known: the circles then lie in the
///   vehicle's plane at top of rail about the point below the sensor, and ahead is where the
///   vehicle heads. Else in the sensor's own plane z = 0.
[[nodiscard]] Drawing DrawRangeRings(double limit_m, const std::optional<MountSpec>& mount);

}  // namespace railcast
