#pragma once

#include <utility>
#include <vector>

#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {

/// A scenario with nothing but a track of these elements, on which the vehicle follows the tangent
/// at its origin.
inline ScenarioSpec BareLine(std::vector<AlignmentElement> elements) {
  ScenarioSpec spec = ReadScenario(ScenariosDir() / "minimal.json");
  spec.world.alignment.course = AlignmentElementsSpec{std::move(elements)};
  spec.world.catenary.enabled = false;
  spec.world.vegetation.trees_per_hectare = 0.0;
  spec.world.vegetation.grass = false;
  spec.vehicle.start_s_m = 100.0;
  spec.vehicle.pivot_distance_m = 0.0;
  return spec;
}

inline ScenarioSpec StraightScenario() {
  return BareLine({{ElementType::kStraight, 2000.0, {}}});
}

/// The vehicle runs at these speeds at these times, with constant acceleration in between.
inline void Drive(std::vector<SpeedPoint> profile, ScenarioSpec& spec) {
  spec.vehicle.motion.profile = std::move(profile);
}
inline SpeedPoint SpeedAt(double time_s, double speed_mps) {
  return {time_s, {}, speed_mps};
}

}  // namespace railcast
