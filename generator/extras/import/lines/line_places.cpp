#include "generator/extras/import/lines/line_places.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <variant>
#include <vector>

#include "generator/extras/import/fit/plan_model.h"

namespace railcast {
namespace {

/// So many steps of a line are searched for the nearest one at once.
constexpr std::size_t kBlock = 64;

}  // namespace

std::vector<LineStretch> WaysAlong(const TrackLine& line, std::span<const double> chainages_m) {
  std::vector<LineStretch> ways;
  for (std::size_t i = 0; i < line.ways.size(); ++i) {
    ways.push_back({chainages_m[i], chainages_m[i + 1], line.ways[i]});
  }
  return ways;
}

std::vector<LineStretch> StretchesWhere(const RailMap& map,
                                        std::span<const LineStretch> ways,
                                        const std::function<bool(const MapTags&)>& has) {
  std::vector<LineStretch> stretches;
  bool goes_on = false;
  for (const LineStretch& way : ways) {
    const bool is_on_it = has(map.ways[way.way].tags);
    if (is_on_it && !goes_on) stretches.push_back({way.begin_s_m, way.begin_s_m, way.way});
    // Feet of points that lie beside each other may change places.
    if (is_on_it) stretches.back().end_s_m = std::max(stretches.back().end_s_m, way.end_s_m);
    goes_on = is_on_it;
  }
  std::erase_if(stretches,
                [](const LineStretch& stretch) { return stretch.end_s_m <= stretch.begin_s_m; });
  return stretches;
}

std::vector<LineStretch> StretchesWhere(const RailMap& map,
                                        const TrackLine& line,
                                        std::span<const double> chainages_m,
                                        const std::function<bool(const MapTags&)>& has) {
  return StretchesWhere(map, WaysAlong(line, chainages_m), has);
}

WayPlaces::WayPlaces(const RailMap& map, const MapWay& way) : map_(map), way_(way) {
  for (std::size_t i = 0; i < way.nodes.size(); ++i) {
    const Eigen::Vector2d& place_m = map.nodes[way.nodes[i]].place_m;
    if (i > 0) length_m_ += (place_m - map.nodes[way.nodes[i - 1]].place_m).norm();
    along_m_.emplace(way.nodes[i], length_m_);
  }
}

double WayPlaces::Of_m(std::size_t node, std::size_t other) const {
  const auto others = along_m_.equal_range(other);
  const auto apart_m = [&](double at_m) {
    double least_m = std::numeric_limits<double>::infinity();
    for (auto one = others.first; one != others.second; ++one) {
      least_m = std::min(least_m, std::abs(one->second - at_m));
    }
    return least_m;
  };
  const auto own = along_m_.equal_range(node);
  if (own.first == own.second) {
    const auto off_m = [&](std::size_t end, double at_m) {
      return std::pair((map_.nodes[end].place_m - map_.nodes[node].place_m).norm(), apart_m(at_m));
    };
    const bool is_first = off_m(way_.nodes.front(), 0.0) <= off_m(way_.nodes.back(), length_m_);
    return is_first ? 0.0 : length_m_;
  }
  return std::min_element(
             own.first, own.second,
             [&](const auto& a, const auto& b) { return apart_m(a.second) < apart_m(b.second); })
      ->second;
}

bool IsDrawnForward(const RailMap& map, const WayStep& step) {
  const WayPlaces places(map, map.ways[step.way]);
  return places.Of_m(step.from, step.to) < places.Of_m(step.to, step.from);
}

LinePlaces::LinePlaces(const RailMap& map, const TrackLine& track, const ImportedLine& line)
    : map_(map),
      track_(track),
      line_(line),
      plan_(PlanOf({line.alignment.origin_m[0], line.alignment.origin_m[1],
                    line.alignment.heading_deg * std::numbers::pi / 180.0, 0.0},
                   std::get<AlignmentElementsSpec>(line.alignment.course).elements)),
      course_(plan_.Course()) {
  for (std::size_t i = 0; i < track.nodes.size(); ++i) {
    const Eigen::Vector2d& place_m = map.nodes[track.nodes[i]].place_m;
    bounds_m_.extend(place_m);
    if (!blocks_m_.empty()) blocks_m_.back().extend(place_m);
    if (i % kBlock == 0) blocks_m_.emplace_back(place_m);
  }
}

std::optional<LinePlace> LinePlaces::Of(const Eigen::Vector2d& place_m, double farthest_m) const {
  if (bounds_m_.exteriorDistance(place_m) > farthest_m) return std::nullopt;
  constexpr double kSlack_m = 5.0;  // Between the points and what is fitted to them.
  LinePlace found;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < track_.nodes.size(); ++i) {
    if (i % kBlock == 0 && blocks_m_[i / kBlock].exteriorDistance(place_m) >
                               std::min(nearest_m, farthest_m + kSlack_m)) {
      i += kBlock - 1;
      continue;
    }
    const Eigen::Vector2d& a_m = map_.nodes[track_.nodes[i]].place_m;
    const Eigen::Vector2d along_m = map_.nodes[track_.nodes[i + 1]].place_m - a_m;
    const double share = std::clamp((place_m - a_m).dot(along_m) / along_m.squaredNorm(), 0.0, 1.0);
    const double distance_m = (place_m - a_m - share * along_m).norm();
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    found.node = i;
    found.s_m = std::lerp(line_.chainages_m[i], line_.chainages_m[i + 1], share);
  }
  if (nearest_m > farthest_m + kSlack_m) return std::nullopt;
  const Foot foot = FootOn(course_, plan_.length_m(), place_m, found.s_m);
  if (std::abs(foot.offset_m) > farthest_m) return std::nullopt;
  found.s_m = foot.s_m;
  found.d_m = foot.offset_m;
  found.beyond_m = foot.beyond_m;
  return found;
}

bool LinePlaces::IsForward(std::size_t node) const {
  return IsDrawnForward(map_, {track_.ways[node], track_.nodes[node], track_.nodes[node + 1]});
}

}  // namespace railcast
