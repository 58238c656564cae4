#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "generator/extras/insert/inserter.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/sensor_sector.h"
#include "tests/support/simple_world.h"

namespace railcast {

/// A sensor before a scene, with which recordings are made and into which things are put.
struct LoopSensor {
  ScenarioSpec scenario;
  ScanPattern pattern;
};

/// A preset with exact intensities: where they err, so does the power that is estimated by them,
/// and another seed is another unit, with other gains.
[[nodiscard]] inline LoopSensor MakeLoopSensor(const std::string& name,
                                               Fidelity fidelity,
                                               const SectorSpec& sector) {
  LoopSensor sensor{ReadMinimalWith(name), {}};
  sensor.scenario.fidelity = fidelity;
  ReceiverSpec& receiver = sensor.scenario.lidar.receiver;
  receiver.intensity_noise = receiver.channel_gain = receiver.channel_gain_variation = 0.0;
  sensor.scenario.lidar.scan = CutSector(sensor.scenario.lidar.scan, sector);
  sensor.pattern = BuildScanPattern(sensor.scenario.lidar.scan);
  return sensor;
}

[[nodiscard]] inline std::shared_ptr<const Model> LoopBox(const ScenarioSpec& scenario,
                                                          const Vector3& size_m,
                                                          const std::string& material,
                                                          const std::string& label) {
  const auto x = static_cast<float>(0.5 * size_m.x());
  const auto y = static_cast<float>(0.5 * size_m.y());
  const auto z = static_cast<float>(size_m.z());
  Mesh mesh{{{-x, -y, 0},
             {x, -y, 0},
             {x, y, 0},
             {-x, y, 0},
             {-x, -y, z},
             {x, -y, z},
             {x, y, z},
             {-x, y, z}},
            {{0, 2, 1},
             {0, 3, 2},
             {4, 5, 6},
             {4, 6, 7},
             {0, 1, 5},
             {0, 5, 4},
             {1, 2, 6},
             {1, 6, 5},
             {2, 3, 7},
             {2, 7, 6},
             {3, 0, 4},
             {3, 4, 7}}};
  return std::make_shared<const Model>(
      Model{"box",
            {{std::move(mesh), MaterialLibrary(scenario.materials).Index(material),
              LabelTable(scenario.labels).Id(label)}}});
}

/// A thing that is put into the scene.
struct LoopThing {
  double ahead_m{};
  double left_m{};
  Vector3 size_m;
  Vector3 velocity_mps = Vector3::Zero();
  std::string material = "clothing";
};

inline void AddThings(const ScenarioSpec& scenario,
                      const std::vector<LoopThing>& things,
                      SimpleWorld& world) {
  for (const LoopThing& thing : things) {
    world.AddObject(LoopBox(scenario, thing.size_m, thing.material, "object"),
                    MakeTransform(Eigen::Matrix3d::Identity(), {thing.ahead_m, thing.left_m, 0.0}),
                    thing.velocity_mps);
  }
}

/// Level ground; walls behind the places of some things, walls that hide the lower half of others,
/// and else the sky.
[[nodiscard]] inline std::shared_ptr<SimpleWorld> MakeLoopScene(const ScenarioSpec& scenario) {
  auto world = std::make_shared<SimpleWorld>();
  const MaterialLibrary materials(scenario.materials);
  const LabelTable labels(scenario.labels);
  world->ground.name = "scene";
  world->ground.parts.push_back(
      {MakeFloor(0.0F, 400.0F), materials.Index("ballast"), labels.Id("ground")});
  const auto add = [&](const Vector3& place_m, const Vector3& size_m) {
    const auto model = LoopBox(scenario, size_m, "concrete", "building");
    world->ground.parts.push_back(model->parts[0]);
    for (Eigen::Vector3f& vertex : world->ground.parts.back().mesh.vertices) {
      vertex += place_m.cast<float>();
    }
  };
  add({14.0, 5.0, 0.0}, {0.3, 8.0, 6.0});
  add({66.0, 16.0, 0.0}, {0.5, 18.0, 12.0});
  add({27.0, -6.5, 0.0}, {0.1, 3.0, 0.9});
  add({90.0, 3.0, 0.0}, {0.1, 6.0, 1.4});
  world->velocity_chunk_mps = {15.0, 0.0, 0.0};
  return world;
}

/// The ballasted track of scenarios/minimal.json up to 100 m ahead, in the axes of the vehicle.
[[nodiscard]] inline std::shared_ptr<SimpleWorld> MakeTrackScene(const ScenarioSpec& scenario) {
  const RailWorld line(scenario.world, scenario.vehicle, LabelTable(scenario.labels),
                       MaterialLibrary(scenario.materials), scenario.seed);
  auto world = std::make_shared<SimpleWorld>();
  world->ground.name = "scene";
  const Transform vehicle_from_world = line.WorldFromVehicle(0).inverse();
  for (const int chunk : line.ChunksInReach(line.HomeChunk(0), 100.0)) {
    const Eigen::Affine3f vehicle_from_chunk =
        (vehicle_from_world * line.WorldFromChunk(chunk)).cast<float>();
    for (Part part : line.BuildChunk(chunk).ground.parts) {
      for (Eigen::Vector3f& vertex : part.mesh.vertices) vertex = vehicle_from_chunk * vertex;
      world->ground.parts.push_back(std::move(part));
    }
  }
  world->velocity_chunk_mps = {15.0, 0.0, 0.0};
  return world;
}

/// From 5 to 200 m: on the ground, before walls and the sky, half hidden, moving.
[[nodiscard]] inline std::vector<LoopThing> LoopThings() {
  return {{5.0, -1.0, {0.4, 0.5, 0.4}},
          {10.0, 1.5, {0.5, 0.6, 1.75}},
          {20.0, -1.0, {0.8, 0.6, 0.3}, {0.0, 1.5, 0.0}},
          {30.0, -7.0, {0.5, 0.7, 1.8}},
          {45.0, 2.5, {0.5, 0.9, 1.9}, {-8.0, 0.0, 0.0}, "white_paint"},
          {62.0, 13.0, {1.0, 2.5, 2.5}},
          {95.0, 3.0, {2.0, 3.5, 3.0}},
          {140.0, -8.0, {2.0, 4.0, 4.0}, {20.0, 0.0, 0.0}},
          {195.0, 6.0, {3.0, 8.0, 8.0}, Vector3::Zero(), "white_paint"}};
}

[[nodiscard]] inline SimulatorSpec LoopSpec(const ScenarioSpec& scenario) {
  SimulatorSpec spec{.detector = DetectorSpecOf(scenario, scenario.lidar, EffectsOf(scenario)),
                     .vehicle_from_sensor = VehicleFromSensor(scenario.lidar.mount),
                     .has_full_detail = true};
  UseWeather(scenario, scenario.weather, spec);
  return spec;
}

[[nodiscard]] inline Frame ScanLoop(const LoopSensor& sensor,
                                    std::shared_ptr<const World> world,
                                    std::uint32_t index = 0) {
  Simulator simulator(std::move(world), sensor.pattern, MaterialLibrary(sensor.scenario.materials),
                      LoopSpec(sensor.scenario), 0);
  Frame frame;
  simulator.Scan(index, frame);
  return frame;
}

/// A frame as it would be read from a recording whose firings are known.
[[nodiscard]] inline RecordedFirings RecordedOf(const Frame& frame, ScanPattern pattern) {
  RecordedFirings firings;
  firings.recorded.frame = frame;
  firings.recorded.is_grid = true;
  firings.recorded.has_pose = true;
  ForEachField(frame, [&](auto name, auto, const auto&) { firings.recorded.fields.emplace(name); });
  firings.firing_of_cell.assign(std::size_t{pattern.rows} * pattern.columns, kNoFiring);
  for (std::uint32_t i = 0; i < pattern.num_firings(); ++i) {
    firings.firing_of_cell[std::size_t{pattern.row[i]} * pattern.columns + pattern.column[i]] = i;
  }
  firings.pattern = std::move(pattern);
  return firings;
}

/// Takes out what only railcast's own recordings know.
inline void ForgetOwnFields(RecordedFirings& firings) {
  for (const char* name : {"power_ratio", "label", "instance", "outcome", "true_range_m",
                           "incidence_rad", "material", "footprint_share", "mixed_share"}) {
    firings.recorded.fields.erase(name);
  }
}

/// @param world The things alone, and the vehicle's way.
[[nodiscard]] inline InsertPlan PlanOf(const ScenarioSpec& scenario,
                                       std::shared_ptr<const World> world,
                                       const ScanPattern& pattern) {
  InsertPlan plan;
  plan.scenario = scenario;
  plan.world = std::move(world);
  for (std::uint32_t i = 0; i < 4; ++i) plan.frame_times_ns.push_back(pattern.StampNs(i));
  return plan;
}

/// The vehicle's way and the things without the scene.
[[nodiscard]] inline std::shared_ptr<SimpleWorld> ThingsAlone(
    const ScenarioSpec& scenario, const std::vector<LoopThing>& things) {
  auto world = std::make_shared<SimpleWorld>();
  world->velocity_chunk_mps = {15.0, 0.0, 0.0};
  AddThings(scenario, things, *world);
  return world;
}

}  // namespace railcast
