#pragma once

#include <Eigen/Core>
#include <vector>

#include "generator/extras/import/fit/plan_model.h"
#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/map/rail_map.h"
#include "railcast/alignment.h"

namespace railcast {

/// The speed that a way usually has by its kind, that is `railway`, `service` and `usage`, where
/// the map gives none (docs/import.md).
/// @param running_kmph Of ways of railways that these tags do not tell from others.
[[nodiscard]] double UsualSpeed_kmph(const MapTags& tags, double running_kmph);

/// The greatest speed in an arc: 11.8 v^2 / R is at most the cant deficiency of an alignment, 60
/// mm, plus the cant that EN 13803-1 allows, which is 150 mm and, lest stiff wagons derail, (R - 50
/// m) / 1.5 m mm.
[[nodiscard]] double SpeedInArc_kmph(double radius_m);

/// The speed on a step of a line from node to node.
struct StepSpeed {
  double speed_kmph{};
  bool is_mapped{};  ///< Whether the map has it for this very way.
};

/// The speed of each of a line's steps, in their order. Where a way has none, that of the nearest
/// one that has counts; where none has, that of its kind (UsualSpeed_kmph).
[[nodiscard]] std::vector<StepSpeed> SpeedsAlong(const RailMap& map,
                                                 const TrackLine& line,
                                                 double running_kmph);

/// What the arcs of a line allow at each step of it, by the points alone: the speed in the circle
/// through three points on the line, up to 50 m before and behind the middle of the step.
[[nodiscard]] std::vector<double> SpeedsOfCurves_kmph(const std::vector<Eigen::Vector2d>& places_m,
                                                      const std::vector<double>& along_m);

/// The speed limits of a line with their chainages: those of its steps, but in arcs, with their
/// clothoids, no more than these allow, in steps of 5 km/h. One that the map has gives way only
/// where its arc has less than 0.8 of the radius that 150 mm of cant and 130 mm of deficiency need.
/// None holds for less than 50 m: a shorter one falls to a slower neighbour, or else it grows.
/// @param feet_m Chainages of the line's nodes.
[[nodiscard]] std::vector<ChainageValue> SpeedLimitsOf(const std::vector<StepSpeed>& speeds,
                                                       const std::vector<double>& feet_m,
                                                       const PlanModel& plan);

/// The speed limit at a chainage.
[[nodiscard]] double SpeedAt_kmph(const std::vector<ChainageValue>& limits_kmph, double s_m);

}  // namespace railcast
