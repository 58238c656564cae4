#pragma once

#include <filesystem>
#include <memory>

#include "railcast/scenario.h"

namespace railcast {

/// scenarios/yard.json and its world.
struct PlannedYard {
  ScenarioSpec scenario =
      ReadScenario(std::filesystem::path(RAILCAST_SOURCE_DIR) / "scenarios" / "yard.json");
  std::shared_ptr<const RailWorld> world = MakeWorld(scenario);
};

}  // namespace railcast
