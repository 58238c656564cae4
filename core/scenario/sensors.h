#pragma once

#include <string>
#include <vector>

#include "core/scenario/scenario_spec.h"

namespace railcast {

/// A sensor and where it stands in the scenario.
struct SensorPlace {
  const LidarSpec& lidar;
  std::string pointer;  ///< "/lidar" or "/lidars/1".
};

/// All sensors of a scenario, in its order; they stand in `spec`.
[[nodiscard]] std::vector<SensorPlace> SensorsOf(const ScenarioSpec& spec);

/// What is wrong with who sends where; empty if nothing is. Names the first fault only.
/// @param sensors All sensors by name; empty if the scenario has but one, under `lidar`.
[[nodiscard]] std::string InterfacesFault(const InterfacesSpec& interfaces,
                                          const std::vector<std::string>& sensors);

}  // namespace railcast
