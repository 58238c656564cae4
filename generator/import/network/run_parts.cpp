#include "generator/import/network/run_parts.h"

#include <algorithm>
#include <cmath>

#include "generator/import/network/tagged_stretches.h"

namespace railcast {

std::optional<TrackRun> PartOfRun(const TrackRun& run, double from_s_m, double to_s_m) {
  constexpr double kShortest_m = 30.0;
  constexpr double kSame_m = 0.5;
  if (to_s_m - from_s_m < kShortest_m) return std::nullopt;
  TrackRun part = run;
  part.points_m = {{from_s_m, OffsetOf_m(run, from_s_m)}};
  for (const Eigen::Vector2d& point_m : run.points_m) {
    if (point_m.x() > from_s_m + kSame_m && point_m.x() < to_s_m - kSame_m) {
      part.points_m.push_back(point_m);
    }
  }
  part.points_m.emplace_back(to_s_m, OffsetOf_m(run, to_s_m));
  return part;
}

std::vector<ChainageRange> TunnelsBelowLine(const RailMap& map,
                                            std::span<const LineStretch> line_ways,
                                            const TrackRun& run) {
  constexpr double kOnAxis_m = 1.5;
  const std::vector<LineStretch> of_line = StretchesWhere(map, line_ways, IsTunnel);
  const auto is_line_outside = [&](double s_m) {
    return std::ranges::none_of(of_line, [&](const LineStretch& tunnel) {
      return s_m > tunnel.begin_s_m - kSameEnd_m && s_m < tunnel.end_s_m + kSameEnd_m;
    });
  };
  const auto is_on_axis = [&](double s_m) { return std::abs(OffsetOf_m(run, s_m)) < kOnAxis_m; };
  std::vector<ChainageRange> below;
  for (const LineStretch& tunnel : StretchesWhere(map, run.ways, IsTunnel)) {
    if (is_on_axis(tunnel.begin_s_m) || is_on_axis(tunnel.end_s_m)) continue;
    bool is_below = false;
    for (double s_m = tunnel.begin_s_m; s_m < tunnel.end_s_m && !is_below; ++s_m) {
      is_below = is_on_axis(s_m) && is_line_outside(s_m);
    }
    if (is_below) below.push_back({tunnel.begin_s_m, tunnel.end_s_m});
  }
  return below;
}

std::vector<TrackRun> PartsBetween(const TrackRun& run, std::span<const ChainageRange> stretches) {
  if (stretches.empty()) return {run};
  std::vector<TrackRun> parts;
  double from_s_m = run.points_m.front().x();
  for (const ChainageRange& stretch : stretches) {
    if (auto part = PartOfRun(run, from_s_m, stretch.begin_s_m)) parts.push_back(*part);
    from_s_m = stretch.end_s_m;
  }
  if (auto part = PartOfRun(run, from_s_m, run.points_m.back().x())) parts.push_back(*part);
  return parts;
}

}  // namespace railcast
