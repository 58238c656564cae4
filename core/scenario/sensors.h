#pragma once

#include <string>
#include <vector>

#include "railcast/scenario.h"

namespace railcast {

/// A sensor and its place in the scenario.
struct SensorPlace {
  const LidarSpec& lidar;
  std::string pointer;  ///< "/lidar" or "/lidars/1".
};

/// All sensors of a scenario, in their order. The result refers to `spec`.
[[nodiscard]] std::vector<SensorPlace> SensorsOf(const ScenarioSpec& spec);

/// The first fault in the assignment of receivers to sensors; empty if there is none.
/// @param sensors The names of all sensors; empty if the scenario has only one, under `lidar`.
[[nodiscard]] std::string InterfacesFault(const InterfacesSpec& interfaces,
                                          const std::vector<std::string>& sensors);

}  // namespace railcast
