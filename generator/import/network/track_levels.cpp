#include "generator/import/network/track_levels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace railcast {

double TrackLevels::OffsetAt_m(double s_m) const {
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (s_m <= levels[i].end_s_m || i + 1 == levels.size()) return levels[i].d_m;
    const TrackLevel& next = levels[i + 1];
    if (s_m >= next.begin_s_m) continue;
    const double share = (s_m - levels[i].end_s_m) / (next.begin_s_m - levels[i].end_s_m);
    const double smooth = share * share * share * (10.0 + share * (6.0 * share - 15.0));
    return std::lerp(levels[i].d_m, next.d_m, smooth);
  }
  return levels.back().d_m;
}

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

}  // namespace railcast
