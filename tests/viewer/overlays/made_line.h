#pragma once

#include <filesystem>
#include <utility>

#include "railcast/scenario.h"
#include "viewer/overlays/overlays.h"

namespace railcast {

/// scenarios/minimal.json on another line, with the vehicle standing at `start_s_m`.
[[nodiscard]] inline ScenarioSpec ScenarioOnLine(AlignmentSpec alignment, double start_s_m) {
  ScenarioSpec scenario =
      ReadScenario(std::filesystem::path(RAILCAST_SOURCE_DIR) / "scenarios" / "minimal.json");
  scenario.world.alignment = std::move(alignment);
  scenario.vehicle.start_s_m = start_s_m;
  return scenario;
}

[[nodiscard]] inline Surroundings SurroundingsOf(const ScenarioSpec& scenario) {
  return {scenario, MakeWorld(scenario)};
}

[[nodiscard]] inline AlignmentSpec Straight(double length_m) {
  AlignmentSpec spec;
  spec.course = AlignmentElementsSpec{{{ElementType::kStraight, length_m, std::nullopt}}};
  return spec;
}

/// An arc from (0, 0) eastward with its centre at (0, radius).
[[nodiscard]] inline AlignmentSpec Arc(double length_m, double radius_m) {
  AlignmentSpec spec;
  spec.course = AlignmentElementsSpec{{{ElementType::kArc, length_m, radius_m}}};
  return spec;
}

/// A frame without points, seen by the scenario's sensor at time 0.
[[nodiscard]] inline RecordedFrame FrameOf(const Surroundings& surroundings) {
  RecordedFrame recorded;
  recorded.has_pose = true;
  recorded.frame.world_from_sensor = surroundings.world->WorldFromVehicle(0) *
                                     VehicleFromSensor(surroundings.scenario.lidar.mount);
  return recorded;
}

}  // namespace railcast
