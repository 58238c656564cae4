#include "tests/bench/scene_settings.h"

#include <algorithm>
#include <cstddef>
#include <functional>

namespace railcast {
namespace {

// Wagons are up to 3.15 m wide, and the demo's train is 64 m long.
constexpr double kBetweenRows_m = 3.75;
constexpr double kBetweenColumns_m = 66.0;
constexpr std::size_t kNumRows = 20;

double TrackOffset_m(const WorldSpec& world, const std::string& name) {
  return std::ranges::find(world.tracks, name, &TrackSpec::name)->offset_m.value_or(0.0);
}

void CopyObjects(ScenarioSpec& scenario, std::size_t factor) {
  const std::vector<ObjectSpec> originals = scenario.world.objects;
  const double vehicle_m = TrackOffset_m(scenario.world, scenario.vehicle.track);
  for (std::size_t i = 1; i < factor; ++i) {
    for (ObjectSpec copy : originals) {
      const double offset_m = TrackOffset_m(scenario.world, copy.track) + copy.d_m;
      const double side = offset_m < vehicle_m ? -1.0 : 1.0;
      copy.name.append("_").append(std::to_string(i));
      copy.d_m += side * kBetweenRows_m * static_cast<double>(i % kNumRows);
      copy.s_m += kBetweenColumns_m * static_cast<double>(i / kNumRows);
      scenario.world.objects.push_back(std::move(copy));
    }
  }
}

}  // namespace

std::vector<SceneSetting> SceneSettings(const ScenarioSpec& scenario) {
  ScenarioSpec base = scenario;
  base.world.vegetation.grass = false;
  base.camera.reset();
  std::vector<SceneSetting> settings = {{"base", base}};
  const auto add = [&](const std::string& name, const std::function<void(ScenarioSpec&)>& change) {
    change(settings.emplace_back(name, base).scenario);
  };
  add("no foliage", [](ScenarioSpec& spec) { spec.world.vegetation.trees_per_hectare = 0.0; });
  add("grass as geometry", [](ScenarioSpec& spec) { spec.world.vegetation.grass = true; });
  add("contact line off", [](ScenarioSpec& spec) { spec.world.catenary.enabled = false; });
  add("10x objects", [](ScenarioSpec& spec) { CopyObjects(spec, 10); });
  add("100x objects", [](ScenarioSpec& spec) { CopyObjects(spec, 100); });
  add("camera on", [](ScenarioSpec& spec) {
    spec.camera = CameraSpec{.width_px = 1920, .height_px = 1080, .horizontal_fov_deg = 60.0};
  });
  return settings;
}

}  // namespace railcast
