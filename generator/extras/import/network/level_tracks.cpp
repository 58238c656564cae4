#include "generator/extras/import/network/level_tracks.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace railcast {
namespace {

/// A stretch on which a track is parallel to its line.
struct TrackLevel {
  double begin_s_m{};
  double end_s_m{};
  double d_m{};
};

/// A track that is parallel to its line but for S-curves between its levels.
struct TrackLevels {
  std::vector<TrackLevel> levels;  ///< At least one, in order of chainage.
};

// Divides a run into levels within 0.35 m of which its points lie, each at least 60 m long, and
// S-curves of radii of 1000 m and more between them. Absent if more than 30 % of the run, or of
// 150 m if it is shorter, lie on none, or if levels change more often than every 200 m.
std::optional<TrackLevels> LevelsOf(const TrackRun& run) {
  constexpr double kBand_m = 0.7;
  constexpr double kShortest_m = 60.0;
  constexpr double kMostLost = 0.3;
  constexpr double kUsual_m = 150.0;
  constexpr double kSpacing_m = 200.0;
  TrackLevels found;
  const std::vector<Eigen::Vector2d>& points_m = run.points_m;
  double on_levels_m = 0.0;
  for (std::size_t i = 0; i + 1 < points_m.size();) {
    double least_m = points_m[i].y();
    double most_m = least_m;
    std::size_t last = i;
    while (last + 1 < points_m.size()) {
      const double d_m = points_m[last + 1].y();
      if (std::max(most_m, d_m) - std::min(least_m, d_m) > kBand_m) break;
      least_m = std::min(least_m, d_m);
      most_m = std::max(most_m, d_m);
      ++last;
    }
    const double length_m = points_m[last].x() - points_m[i].x();
    if (length_m < kShortest_m) {
      ++i;
      continue;
    }
    found.levels.push_back({points_m[i].x(), points_m[last].x(), std::midpoint(least_m, most_m)});
    on_levels_m += length_m;
    i = last;
  }
  const double length_m = points_m.back().x() - points_m.front().x();
  if (found.levels.empty() || length_m - on_levels_m > kMostLost * std::max(length_m, kUsual_m) ||
      static_cast<double>(found.levels.size()) > 2.0 + length_m / kSpacing_m) {
    return std::nullopt;
  }
  // Room for S-curves: the largest curvature of one is 5.8 times its width over its squared length.
  constexpr double kRadius_m = 1000.0;
  constexpr double kSharpness = 5.8;
  for (std::size_t i = 0; i + 1 < found.levels.size(); ++i) {
    TrackLevel& level = found.levels[i];
    TrackLevel& next = found.levels[i + 1];
    const double half_m =
        0.5 * std::sqrt(kSharpness * kRadius_m * std::abs(next.d_m - level.d_m)) + 0.5;
    const double middle_m = std::midpoint(level.end_s_m, next.begin_s_m);
    level.end_s_m = std::min(level.end_s_m, middle_m - half_m);
    next.begin_s_m = std::max(next.begin_s_m, middle_m + half_m);
  }
  const bool has_room = std::ranges::all_of(
      found.levels, [](const TrackLevel& level) { return level.end_s_m - level.begin_s_m > 1.0; });
  return has_room ? std::optional(found) : std::nullopt;
}

/// Chainage at which a run's points cross an offset first, or last.
std::optional<double> CrossingOf(const TrackRun& run, double d_m, bool is_last) {
  std::optional<double> crossing_s_m;
  for (std::size_t i = 1; i < run.points_m.size(); ++i) {
    const Eigen::Vector2d& a = run.points_m[i - 1];
    const Eigen::Vector2d& b = run.points_m[i];
    if ((a.y() - d_m) * (b.y() - d_m) > 0.0 || a.y() == b.y()) continue;
    crossing_s_m = a.x() + (d_m - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (!is_last) break;
  }
  return crossing_s_m;
}

/// The turnout from which a branch is half way over to its level where the map has it so.
std::optional<TurnoutSpec> TurnoutTowards(const TrackNetwork& network,
                                          const TrackRun& run,
                                          double level_m,
                                          const Meeting& meeting) {
  const TrackDraft& other = network.tracks()[meeting.track];
  const TurnoutType type = TurnoutFor(SpeedOfRun_kmph(run, meeting.s_m));
  const TurnoutGeometry shape = GeometryOf(type);
  const double forwards = meeting.opens_ahead ? 1.0 : -1.0;
  // Other tracks may be a little oblique: their offset half way counts.
  const std::optional<double> half_s_m = CrossingOf(
      run, 0.5 * (level_m + other.course.OffsetAt(meeting.s_m).d_m), !meeting.opens_ahead);
  if (!half_s_m || !other.Has(*half_s_m)) return std::nullopt;
  const double distance_m = std::abs(level_m - other.course.OffsetAt(*half_s_m).d_m);
  const double half_m = 0.5 * distance_m / std::tan(shape.angle_rad) + shape.tangent_m;
  const double s_m = *half_s_m - forwards * half_m;
  constexpr double kFarthest_m = 15.0;
  if (std::abs(s_m - meeting.s_m) > kFarthest_m) return std::nullopt;
  return TurnoutSpec{.track = other.spec.name,
                     .s_m = RoundedTo(s_m, 1e3),
                     .turnout = type,
                     .side = {},
                     .position = {}};
}

struct Ends {
  std::optional<TurnoutSpec> begin;
  std::optional<TurnoutSpec> end;
};

std::optional<TrackDraft> DraftWith(const TrackNetwork& network,
                                    const TrackRun& run,
                                    const TrackLevels& levels,
                                    const Ends& ends) {
  const TrackLevel& first = levels.levels.front();
  const TrackLevel& last = levels.levels.back();
  TrackSpec spec;
  spec.begin = ends.begin;
  spec.end = ends.end;
  // Without a turnout, a track begins and ends where it is apart from others.
  constexpr double kShortest_m = 20.0;
  double begin_s_m = ends.begin ? *ends.begin->s_m : first.begin_s_m;
  double end_s_m = ends.end ? *ends.end->s_m : last.end_s_m;
  while (!ends.begin && begin_s_m < end_s_m && !network.IsApartAt(begin_s_m, first.d_m)) {
    ++begin_s_m;
  }
  while (!ends.end && begin_s_m < end_s_m && !network.IsApartAt(end_s_m, last.d_m)) --end_s_m;
  if (end_s_m - begin_s_m < kShortest_m || begin_s_m > first.end_s_m || end_s_m < last.begin_s_m) {
    return std::nullopt;
  }
  if (!ends.begin) spec.start_s_m = RoundedTo(begin_s_m, 1e3);
  if (!ends.end) spec.end_s_m = RoundedTo(end_s_m, 1e3);
  if (levels.levels.size() == 1) {
    spec.offset_m = RoundedTo(first.d_m, 1e3);
  } else {
    for (const TrackLevel& level : levels.levels) {
      for (const double s_m : {level.begin_s_m, level.end_s_m}) {
        spec.offsets_m.push_back({RoundedTo(s_m, 1e3), RoundedTo(level.d_m, 1e3)});
      }
    }
    // The first and the last level go on to the ends.
    spec.offsets_m.erase(spec.offsets_m.begin());
    spec.offsets_m.pop_back();
  }
  std::optional<TrackDraft> draft = network.Make(spec);
  if (!draft || !Follows(*draft, run) || network.FirstConflict_m(*draft)) return std::nullopt;
  return draft;
}

}  // namespace

bool Follows(const TrackDraft& draft, const TrackRun& run) {
  constexpr double kNear_m = 1.0;
  constexpr double kFarthest_m = 2.0;
  constexpr double kShare = 0.8;
  int num_points = 0;
  int num_near = 0;
  for (const Eigen::Vector2d& point_m : run.points_m) {
    if (!draft.Has(point_m.x())) continue;
    const double off_m = std::abs(draft.course.OffsetAt(point_m.x()).d_m - point_m.y());
    if (off_m > kFarthest_m) return false;
    ++num_points;
    if (off_m <= kNear_m) ++num_near;
  }
  return num_near >= kShare * num_points;
}

std::optional<TrackDraft> LevelTrackOf(const TrackNetwork& network,
                                       const TrackRun& run,
                                       const std::optional<Meeting>& begin,
                                       const std::optional<Meeting>& end) {
  const std::optional<TrackLevels> levels = LevelsOf(run);
  if (!levels) return std::nullopt;
  Ends ends;
  if (begin) ends.begin = TurnoutTowards(network, run, levels->levels.front().d_m, *begin);
  if (end) ends.end = TurnoutTowards(network, run, levels->levels.back().d_m, *end);
  for (const auto& [has_begin, has_end] : {std::pair(true, true), std::pair(true, false),
                                           std::pair(false, true), std::pair(false, false)}) {
    if ((has_begin && !ends.begin) || (has_end && !ends.end)) continue;
    std::optional<TrackDraft> draft =
        DraftWith(network, run, *levels,
                  {has_begin ? ends.begin : std::nullopt, has_end ? ends.end : std::nullopt});
    if (draft) return draft;
  }
  return std::nullopt;
}

}  // namespace railcast
