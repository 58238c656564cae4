#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "railcast/io/recording.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"
#include "tests/analysis/extras/preset/preset_scenario.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/simple_world.h"

namespace railcast {

inline constexpr double kHeight_m = 1.8;
inline constexpr float kWall_m = 14.0F;

/// A floor of asphalt below the sensor and a wall of concrete before it.
[[nodiscard]] inline std::shared_ptr<SimpleWorld> MakeYard(const MaterialLibrary& materials) {
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts.push_back(
      {MakeFloor(static_cast<float>(-kHeight_m), 30.0F), materials.Index("asphalt"), 1});
  world->ground.parts.push_back({MakeWall(kWall_m, 10.0F), materials.Index("concrete"), 1});
  return world;
}

/// Three turns of the scenario's sensor in the yard.
[[nodiscard]] inline std::vector<RecordedFrame> RecordYard(const ScenarioSpec& scenario) {
  const MaterialLibrary materials(scenario.materials);
  DetectorSpec detector = DetectorSpecOf(scenario, scenario.lidar, EffectsOf(scenario));
  detector.seed = 77;  // Other numbers than those of the replay.
  Simulator simulator(MakeYard(materials), BuildScanPattern(scenario.lidar.scan), materials,
                      {.detector = detector}, 0);
  std::vector<RecordedFrame> frames(3);
  for (std::uint32_t i = 0; i < frames.size(); ++i) {
    simulator.Scan(i, frames[i].frame);
    frames[i].is_grid = true;
    frames[i].fields = {"x", "y", "z", "intensity", "range_m", "ring", "column"};
  }
  return frames;
}

[[nodiscard]] inline ScenarioSpec LossyVlp16() {
  ScenarioSpec scenario = PresetScenario("vlp16");
  scenario.lidar.plausibility.dropout_probability = 0.05;
  // Replays have neither.
  scenario.lidar.receiver.intensity_noise = 0.0;
  for (Material& material : scenario.materials) material.texture = 0.0;
  return scenario;
}

}  // namespace railcast
