#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/detectability/object_detection.h"
#include "analysis/report/report.h"
#include "railcast/scenario.h"

namespace railcast {

/// The words of reports on sight (report/words.h).
extern const char* const kSightWords;

/// What is looked for from where.
struct SightSpec {
  /// Heights of targets above top of rail: a thing on the track, a child or an animal, a person.
  std::vector<double> heights_m = {0.3, 1.0, 2.0};
  double step_m = 10.0;  ///< From one place to the next, at least.
  /// How far from the sensor the targets are sought; absent = its greatest range.
  std::optional<double> range_m{};
  BrakingSpec braking{};
  /// At which the vehicle runs from its start to the end of its route; absent = as the scenario has
  /// it move.
  std::optional<double> speed_mps{};
};

/// Width of a target, which stands square across the track on its axis.
inline constexpr double kTargetWidth_m = 0.5;
/// The nearest target's distance from the sensor.
inline constexpr double kNearestTarget_m = 10.0;
/// From one target to the next.
inline constexpr double kTargetStep_m = 1.0;
/// Sight does not end where a target is hidden on a shorter way than this, as behind a mast.
inline constexpr double kMostHidden_m = 10.0;

/// What ends the sight.
enum class SightEnd {
  kBlocked,
  kRange,       ///< Nothing within the range.
  kEndOfTrack,  ///< Nothing up to the end of the route: how far one could see on is not known.
};

/// How far ahead along the track a target is seen.
struct Sight {
  /// Along the track, from the sensor's place on it; 0 if the nearest target is hidden.
  double distance_m{};
  SightEnd end{};
  std::string blocker;  ///< Label of most of what hides the first target out of sight.
};

/// A place on the vehicle's way.
struct SightPlace {
  std::uint32_t frame{};
  double chainage_m{};          ///< The sensor's chainage.
  double speed_mps{};           ///< The vehicle's speed there.
  double gradient{};            ///< Mean over the braking distance, in the direction of travel.
  double stop_m{};              ///< Braking distance.
  double needed_m{};            ///< With the margin.
  std::vector<Sight> sights{};  ///< One for each height.

  /// Whether the sight of a target is known to end before the distance needed.
  [[nodiscard]] bool IsShort(std::size_t height) const {
    return sights[height].end != SightEnd::kEndOfTrack && sights[height].distance_m < needed_m;
  }
};

/// Looks for targets from places on the vehicle's way, at the times when it is there. A target is
/// seen if at least half of its face is in line of sight of the sensor's nominal place. Rays sample
/// it, blocked by any surface but wires: 5 rows of 5, then 11 of 11 and so on to 95 of 95, until
/// that changes the sight by less than kTargetStep_m.
/// @param scenario Of one sensor.
/// @param on_progress Called with the share of the places that are done.
/// @throws InputError as MakeSimulator() does, and "at 120 m: cannot stop: ..." (StopOf()).
[[nodiscard]] std::vector<SightPlace> FollowSight(const ScenarioSpec& scenario,
                                                  const SightSpec& spec,
                                                  const std::function<void(double)>& on_progress);

/// A part of the way on which the sight of one target is shorter than the distance needed, and
/// ends at the same label.
struct ShortSight {
  double from_s_m{};  ///< Chainages of the first and the last place.
  double to_s_m{};
  double height_m{};
  std::string blocker;  ///< "range" if nothing blocks.
  SightPlace worst;     ///< Where least is to spare.
  Sight sight;          ///< The one of `worst`.

  [[nodiscard]] double spare_m() const { return sight.distance_m - worst.needed_m; }
};

/// The parts of the way with too short a sight, by height and in the order in which they are
/// passed.
[[nodiscard]] std::vector<ShortSight> ShortSights(const std::vector<SightPlace>& places,
                                                  const SightSpec& spec);

/// @pre There is a place.
/// @param range_m How far targets were sought.
[[nodiscard]] Report MakeSightReport(const std::vector<SightPlace>& places,
                                     const SightSpec& spec,
                                     double range_m,
                                     const std::string& command);

}  // namespace railcast
