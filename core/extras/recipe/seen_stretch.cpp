#include "core/extras/recipe/seen_stretch.h"

#include <algorithm>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scenario/sensors.h"

namespace railcast {

ScenarioSpec WithRecipeSensor(const Recipe& recipe, const ScenarioSpec& scenario) {
  if (!recipe.sensor && scenario.lidars.size() > 1) return scenario;
  return AtPlace(ShownPath(recipe.file.lexically_normal()) + ": /",
                 [&] { return PickSensor(scenario, recipe.sensor); });
}

MadeStamps StampsOf(const Recipe& recipe, const ScanPattern& pattern) {
  MadeStamps stamps;
  if (recipe.warm_up_frames > 0) stamps.frames.push_back(0);
  for (std::uint32_t i = 0; i < recipe.num_frames; ++i) {
    stamps.frames.push_back(recipe.warm_up_frames + i * recipe.stride);
  }
  for (const std::uint32_t frame : stamps.frames) {
    stamps.stamps_ns.push_back(pattern.StampNs(frame));
  }
  return stamps;
}

double SightOf_m(const Recipe& recipe, const ScenarioSpec& scenario) {
  if (recipe.split.sight_m) return *recipe.split.sight_m;
  double range_max_m = 0.0;
  for (const SensorPlace& sensor : SensorsOf(scenario)) {
    range_max_m = std::max(range_max_m, sensor.lidar.range_max_m);
  }
  return range_max_m;
}

SeenStretch SeenStretchOf(const RailWorld& world, const MadeStamps& stamps, double sight_m) {
  std::vector<double> chainages_m;
  for (const std::int64_t stamp_ns : stamps.stamps_ns) {
    chainages_m.push_back(world.VehicleChainage_m(stamp_ns));
  }
  const auto [least, most] = std::ranges::minmax(chainages_m);
  return {least - sight_m, most + sight_m};
}

std::uint32_t NumStartsIn(const Recipe& recipe, const RecordedBase& run) {
  return run.num_frames() - recipe.num_frames + 1;
}

SeenStretch SeenStretchFrom(const Recipe& recipe,
                            const RecordedBase& run,
                            std::uint32_t first_frame,
                            double sight_m) {
  double least_m = run.frames().at(first_frame).s_m;
  double most_m = least_m;
  for (std::uint32_t i = 1; i < recipe.num_frames; ++i) {
    const double s_m = run.frames().at(first_frame + i).s_m;
    least_m = std::min(least_m, s_m);
    most_m = std::max(most_m, s_m);
  }
  return {least_m - sight_m, most_m + sight_m};
}

}  // namespace railcast
