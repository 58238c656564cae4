#pragma once

#include <memory>

#include "core/rail/rail_world.h"
#include "core/scenario/scenario_spec.h"

namespace railcast {

/// What a scenario says of the world about the sensor.
struct Surroundings {
  ScenarioSpec scenario;  ///< Of one sensor.
  std::shared_ptr<const RailWorld> world;
};

}  // namespace railcast
