#pragma once

#include <string>

#include "railcast/scenario.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {

/// A scenario with one of the shipped sensors on rung `surface`, in clear air.
[[nodiscard]] inline ScenarioSpec PresetScenario(const std::string& sensor) {
  const TemporaryFolder folder;
  const std::string scenarios = ScenariosDir().string();
  return ReadScenario(folder.Write("preset.json", R"({
    "version": 1,
    "file": ")" + scenarios + R"(/minimal.json",
    "fidelity": "surface",
    "lidar": {"file": ")" + scenarios + "/sensors/" + sensor +
                                                      R"(.json"}
  })"));
}

}  // namespace railcast
