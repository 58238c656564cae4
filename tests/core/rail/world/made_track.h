#pragma once

#include <filesystem>
#include <optional>

#include "core/rail/world/own_track.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"

namespace railcast {

/// A line of one element, from (0, 0) eastward, with a second track 4 m to the left of the
/// vehicle's.
[[nodiscard]] inline ScenarioSpec ScenarioOn(ElementType element,
                                             double length_m,
                                             std::optional<double> radius_m = std::nullopt) {
  ScenarioSpec scenario =
      ReadScenario(std::filesystem::path(RAILCAST_SOURCE_DIR) / "scenarios" / "minimal.json");
  scenario.world.alignment = {};
  scenario.world.alignment.course = AlignmentElementsSpec{{{element, length_m, radius_m}}};
  TrackSpec second{.name = "second", .offset_m = 4.0};
  scenario.world.tracks = {TrackSpec(), second};
  scenario.world.objects.clear();
  return scenario;
}

[[nodiscard]] inline OwnTrack OwnTrackOf(const ScenarioSpec& scenario) {
  return {*MakeWorld(scenario), scenario.world.catenary};
}

/// A straight track of 2000 m.
[[nodiscard]] inline const OwnTrack& StraightTrack() {
  static const OwnTrack track = OwnTrackOf(ScenarioOn(ElementType::kStraight, 2'000.0));
  return track;
}

}  // namespace railcast
