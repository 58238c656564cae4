#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/rail/line/track_course.h"
#include "generator/extras/import/fit/plan_model.h"
#include "generator/extras/import/lines/line_places.h"
#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/map/rail_map.h"

namespace railcast {

/// A stretch of track on the map that runs along a line.
struct TrackRun {
  std::string kind;  ///< "siding", "yard", "crossover", "spur" or "running".
  /// Chainage and offset of its points, with rising chainage.
  std::vector<Eigen::Vector2d> points_m;
  std::vector<std::size_t> nodes;  ///< Nodes of the map, one for each point.
  std::vector<LineStretch> ways;   ///< From point to point.
  /// From point to point: that of the map or else the usual one of its kind, but no more than its
  /// curves allow.
  std::vector<double> speeds_kmph;
  bool is_electrified = true;
};

/// The kind of a track by its key `service`: itself, or "running" without it, or "other" if it is
/// no word.
[[nodiscard]] std::string KindOf(std::string_view service);

/// How far from their line runs are looked for.
inline constexpr double kRunStrip_m = 60.0;

/// A step beside a line but in none of its runs.
struct UnusedStep {
  WayStep step;
  const char* reason{};
  std::string kind{};   ///< As of a run.
  ChainageRange s_m{};  ///< Chainages of its ends that are beside the line.
};

/// What of a map's tracks runs beside a line, and what there does not.
struct RunsBeside {
  std::vector<TrackRun> runs;
  std::vector<UnusedStep> unused;
};

/// All runs beside a line. The longest come first, but none before those within which it begins or
/// ends; of runs that begin or end in each other, the longest comes first.
/// @param running_kmph Of running tracks for which the map has no speed.
[[nodiscard]] RunsBeside FindRuns(const RailMap& map,
                                  const TrackLine& line,
                                  const LinePlaces& places,
                                  double running_kmph);

/// The offset at a chainage, along the lines between two points or more of chainage and offset;
/// beyond their ends, along the first and the last of them.
[[nodiscard]] double OffsetOf_m(std::span<const Eigen::Vector2d> points_m, double s_m);

/// The speed of a run at a chainage; beyond its ends, as at these.
[[nodiscard]] double SpeedOfRun_kmph(const TrackRun& run, double s_m);

/// The part of a plan between two lengths along it; its start is not set.
[[nodiscard]] PlanModel PartOf(const PlanModel& plan, double begin_m, double end_m);

/// The part of a run between two chainages of it; absent if it is shorter than 30 m.
[[nodiscard]] std::optional<TrackRun> PartOfRun(const TrackRun& run,
                                                double from_s_m,
                                                double to_s_m);

/// The tunnels of a run in which it is below its line: on the axis of the line's own track, which
/// is in no tunnel there. A tunnel that begins or ends on the axis is none of them.
/// @param line_ways Of the line's own track.
[[nodiscard]] std::vector<ChainageRange> TunnelsBelowLine(const RailMap& map,
                                                          std::span<const LineStretch> line_ways,
                                                          const TrackRun& run);

/// What is left of a run without some stretches of it, as far as it is 30 m long. Without any
/// stretches this is the run itself.
/// @param stretches In order of chainage.
[[nodiscard]] std::vector<TrackRun> PartsBetween(const TrackRun& run,
                                                 std::span<const ChainageRange> stretches);

}  // namespace railcast
