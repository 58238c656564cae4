#pragma once

#include <cstdint>

#include "core/extras/recipe/object_placement.h"
#include "core/extras/recipe/recipe.h"
#include "railcast/lidar.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"

namespace railcast {

/// A stretch of a line.
struct SeenStretch {
  double begin_s_m{};
  double end_s_m{};

  [[nodiscard]] SeenStretch ShiftedBy(double distance_m) const {
    return {begin_s_m + distance_m, end_s_m + distance_m};
  }
};

/// The scenario with the sensor that the recipe chooses; with all of them if it chooses none.
/// @throws InputError that names the recipe's key if there is no such sensor.
[[nodiscard]] ScenarioSpec WithRecipeSensor(const Recipe& recipe, const ScenarioSpec& scenario);

/// The frames that are made of a scenario, by its first sensor's pattern.
[[nodiscard]] MadeStamps StampsOf(const Recipe& recipe, const ScanPattern& pattern);

/// How far a scenario sees along the line: as the recipe says, or as its sensors reach.
[[nodiscard]] double SightOf_m(const Recipe& recipe, const ScenarioSpec& scenario);

/// All that a scenario sees of its line, from the first to the last of the frames.
[[nodiscard]] SeenStretch SeenStretchOf(const RailWorld& world,
                                        const MadeStamps& stamps,
                                        double sight_m);

/// Number of frames of a recording with which a scenario of the recipe may begin.
[[nodiscard]] std::uint32_t NumStartsIn(const Recipe& recipe, const RecordedBase& run);

/// All that such a scenario sees, in the chainage of plans.
[[nodiscard]] SeenStretch SeenStretchFrom(const Recipe& recipe,
                                          const RecordedBase& run,
                                          std::uint32_t first_frame,
                                          double sight_m);

}  // namespace railcast
