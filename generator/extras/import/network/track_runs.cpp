#include "generator/extras/import/network/track_runs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "generator/extras/import/lines/line_tags.h"
#include "generator/extras/import/lines/speed_limits.h"

namespace railcast {
namespace {

constexpr const char* kServiceKey = "import:service";

/// A part of a map.
struct OtherWays {
  RailMap map;
  std::vector<std::size_t> ways;  ///< Ways of the whole map, in their order.
};

/// The ways that a line does not use, all of them running tracks, so that FindLines takes them.
OtherWays OthersThan(const RailMap& map, const TrackLine& line) {
  const std::set<std::size_t> used(line.ways.begin(), line.ways.end());
  OtherWays others;
  others.map.nodes = map.nodes;
  for (std::size_t i = 0; i < map.ways.size(); ++i) {
    if (used.contains(i)) continue;
    MapWay way = map.ways[i];
    const std::string service(TagOf(way.tags, "service"));
    way.tags.erase("service");
    way.tags[kServiceKey] = service;
    others.map.ways.push_back(std::move(way));
    others.ways.push_back(i);
  }
  return others;
}

/// What most of a stretch of a line of ways has, by number of points.
std::string CommonTag(const RailMap& map,
                      std::vector<std::size_t>::const_iterator begin,
                      std::vector<std::size_t>::const_iterator end,
                      std::string_view key) {
  std::map<std::string_view, int> counts;
  for (auto way = begin; way != end; ++way) ++counts[TagOf(map.ways[*way].tags, key)];
  if (counts.empty()) return "";
  return std::string(
      std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; })->first);
}

class RunCutter {
 public:
  RunCutter(const RailMap& whole,
            const OtherWays& others,
            const LinePlaces& places,
            double running_kmph)
      : whole_(whole),
        map_(others.map),
        ways_(others.ways),
        places_(places),
        running_kmph_(running_kmph) {}

  [[nodiscard]] RunsBeside& beside() { return beside_; }

  void Cut(const TrackLine& chain) {
    std::size_t first = 0;
    std::vector<Eigen::Vector2d> points_m;
    std::vector<std::optional<Eigen::Vector2d>> places_m;
    for (const std::size_t node : chain.nodes) places_m.push_back(PointOf(node));
    reasons_.assign(chain.ways.size(), nullptr);
    for (std::size_t i = 0; i < reasons_.size(); ++i) {
      if (places_m[i] && places_m[i + 1]) reasons_[i] = "it does not run along the line";
      if (places_m[i].has_value() != places_m[i + 1].has_value()) {
        reasons_[i] = "it leaves the 60 m beside the line";
      }
    }
    for (std::size_t i = 0; i < chain.nodes.size(); ++i) {
      const auto& point_m = places_m[i];
      if (point_m && (points_m.empty() || GoesOn(points_m, *point_m))) {
        if (points_m.empty()) first = i;
        points_m.push_back(*point_m);
        continue;
      }
      End(chain, first, points_m);
      points_m.clear();
      if (!point_m) continue;
      // The run ends here, and the next one may begin with its last point.
      const auto& before_m = places_m[i - 1];
      if (before_m && GoesOn({*before_m}, *point_m)) points_m = {*before_m};
      first = i - points_m.size();
      points_m.push_back(*point_m);
    }
    End(chain, first, points_m);
    for (std::size_t i = 0; i < reasons_.size(); ++i) {
      if (!reasons_[i]) continue;
      const std::size_t way = ways_[chain.ways[i]];
      const double one_s_m = (places_m[i] ? places_m[i] : places_m[i + 1])->x();
      const double other_s_m = (places_m[i + 1] ? places_m[i + 1] : places_m[i])->x();
      beside_.unused.push_back({{way, chain.nodes[i], chain.nodes[i + 1]},
                                reasons_[i],
                                KindOf(TagOf(whole_.ways[way].tags, "service")),
                                {std::min(one_s_m, other_s_m), std::max(one_s_m, other_s_m)}});
    }
  }

 private:
  [[nodiscard]] std::optional<Eigen::Vector2d> PointOf(std::size_t node) const {
    const auto place = places_.Of(map_.nodes[node].place_m, kRunStrip_m);
    constexpr double kAtEnd_m = 1.0;
    if (!place || place->s_m < kAtEnd_m || place->s_m > places_.length_m() - kAtEnd_m) {
      return std::nullopt;
    }
    return Eigen::Vector2d(place->s_m, place->d_m);
  }

  /// Whether a point continues others in their direction and along the line.
  [[nodiscard]] static bool GoesOn(const std::vector<Eigen::Vector2d>& points_m,
                                   const Eigen::Vector2d& point_m) {
    const double steepest = std::tan(20.0 * std::numbers::pi / 180.0);
    const Eigen::Vector2d step_m = point_m - points_m.back();
    if (!(std::abs(step_m.y()) < steepest * std::abs(step_m.x()))) return false;
    return points_m.size() < 2 || step_m.x() * (points_m[1].x() - points_m[0].x()) > 0.0;
  }

  void End(const TrackLine& chain, std::size_t first, std::vector<Eigen::Vector2d> points_m) {
    constexpr double kShortest_m = 20.0;
    if (points_m.size() < 2) return;
    const bool is_short = std::abs(points_m.back().x() - points_m.front().x()) < kShortest_m;
    std::fill_n(reasons_.begin() + static_cast<std::ptrdiff_t>(first), points_m.size() - 1,
                is_short ? "it runs along the line for less than 20 m" : nullptr);
    if (is_short) return;
    const auto begin = chain.ways.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = begin + static_cast<std::ptrdiff_t>(points_m.size()) - 1;
    TrackRun run;
    run.kind = KindOf(CommonTag(map_, begin, end, kServiceKey));
    const std::string electrified = CommonTag(map_, begin, end, "electrified");
    run.is_electrified = !HasNoContactLine(electrified);
    const auto node = chain.nodes.begin() + static_cast<std::ptrdiff_t>(first);
    run.nodes.assign(node, node + static_cast<std::ptrdiff_t>(points_m.size()));
    for (std::size_t i = 0; i + 1 < points_m.size(); ++i) {
      const auto [from_s_m, to_s_m] = std::minmax(points_m[i].x(), points_m[i + 1].x());
      run.ways.push_back({from_s_m, to_s_m, ways_[*(begin + static_cast<std::ptrdiff_t>(i))]});
    }
    run.speeds_kmph = SpeedsOf_kmph(run);
    if (points_m.back().x() < points_m.front().x()) {
      std::ranges::reverse(points_m);
      std::ranges::reverse(run.nodes);
      std::ranges::reverse(run.ways);
      std::ranges::reverse(run.speeds_kmph);
    }
    run.points_m = std::move(points_m);
    beside_.runs.push_back(std::move(run));
  }

  [[nodiscard]] std::vector<double> SpeedsOf_kmph(const TrackRun& run) const {
    TrackLine line{{}, run.nodes, {}};
    for (const LineStretch& way : run.ways) line.ways.push_back(way.way);
    std::vector<Eigen::Vector2d> places_m;
    std::vector<double> along_m;
    for (const std::size_t node : run.nodes) {
      const Eigen::Vector2d& place_m = whole_.nodes[node].place_m;
      along_m.push_back(along_m.empty() ? 0.0
                                        : along_m.back() + (place_m - places_m.back()).norm());
      places_m.push_back(place_m);
    }
    const std::vector<StepSpeed> of_ways = SpeedsAlong(whole_, line, running_kmph_);
    const std::vector<double> of_curves_kmph = SpeedsOfCurves_kmph(places_m, along_m);
    std::vector<double> speeds_kmph;
    for (std::size_t i = 0; i < of_ways.size(); ++i) {
      const MapTags& tags = whole_.ways[line.ways[i]].tags;
      double speed_kmph = of_ways[i].speed_kmph;
      if (!of_ways[i].is_mapped) {
        // A siding has nothing of the running track into which it goes on.
        if (!TagOf(tags, "service").empty()) speed_kmph = UsualSpeed_kmph(tags, running_kmph_);
        speed_kmph = std::min(speed_kmph, of_curves_kmph[i]);
      }
      speeds_kmph.push_back(speed_kmph);
    }
    return speeds_kmph;
  }

  const RailMap& whole_;
  const RailMap& map_;  ///< Without the ways of the line.
  const std::vector<std::size_t>& ways_;
  const LinePlaces& places_;
  double running_kmph_;
  RunsBeside beside_;
  std::vector<const char*> reasons_;  ///< Why the steps of a chain are in no run.
};

/// For each run those within which it begins or ends.
std::vector<std::vector<std::size_t>> TracksMet(const std::vector<TrackRun>& runs) {
  std::map<std::size_t, std::vector<std::size_t>> runs_through;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (std::size_t k = 1; k + 1 < runs[i].nodes.size(); ++k) {
      runs_through[runs[i].nodes[k]].push_back(i);
    }
  }
  std::vector<std::vector<std::size_t>> met(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (const std::size_t node : {runs[i].nodes.front(), runs[i].nodes.back()}) {
      const auto found = runs_through.find(node);
      if (found == runs_through.end()) continue;
      met[i].insert(met[i].end(), found->second.begin(), found->second.end());
    }
  }
  return met;
}

/// @param runs The longest first.
std::vector<TrackRun> InOrderOfMeetings(std::vector<TrackRun> runs) {
  const std::vector<std::vector<std::size_t>> met = TracksMet(runs);
  std::vector<bool> is_taken(runs.size());
  const auto waits_for = [&](std::size_t run) -> std::optional<std::size_t> {
    const auto found =
        std::ranges::find_if(met[run], [&](std::size_t other) { return !is_taken[other]; });
    return found == met[run].end() ? std::nullopt : std::optional(*found);
  };
  std::vector<TrackRun> ordered;
  while (ordered.size() < runs.size()) {
    std::size_t next = 0;
    while (next < runs.size() && (is_taken[next] || waits_for(next))) ++next;
    if (next == runs.size()) {
      // All wait for each other: the longest of a circle goes first.
      std::size_t at = 0;
      while (is_taken[at]) ++at;
      for (std::size_t step = 0; step < runs.size(); ++step) at = *waits_for(at);
      next = at;
      for (std::size_t in_circle = *waits_for(at); in_circle != at;) {
        next = std::min(next, in_circle);
        in_circle = *waits_for(in_circle);
      }
    }
    is_taken[next] = true;
    ordered.push_back(std::move(runs[next]));
  }
  return ordered;
}

}  // namespace

std::string KindOf(std::string_view service) {
  if (service.empty()) return "running";
  const bool is_word = std::ranges::all_of(
      service, [](char letter) { return letter == '_' || (letter >= 'a' && letter <= 'z'); });
  return is_word ? std::string(service) : "other";
}

std::optional<TrackRun> PartOfRun(const TrackRun& run, double from_s_m, double to_s_m) {
  constexpr double kShortest_m = 30.0;
  constexpr double kSame_m = 0.5;
  if (to_s_m - from_s_m < kShortest_m) return std::nullopt;
  TrackRun part = run;
  part.points_m = {{from_s_m, OffsetOf_m(run.points_m, from_s_m)}};
  for (const Eigen::Vector2d& point_m : run.points_m) {
    if (point_m.x() > from_s_m + kSame_m && point_m.x() < to_s_m - kSame_m) {
      part.points_m.push_back(point_m);
    }
  }
  part.points_m.emplace_back(to_s_m, OffsetOf_m(run.points_m, to_s_m));
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
  const auto is_on_axis = [&](double s_m) {
    return std::abs(OffsetOf_m(run.points_m, s_m)) < kOnAxis_m;
  };
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

RunsBeside FindRuns(const RailMap& map,
                    const TrackLine& line,
                    const LinePlaces& places,
                    double running_kmph) {
  const OtherWays others = OthersThan(map, line);
  RunCutter cutter(map, others, places, running_kmph);
  for (const TrackLine& chain : FindLines(others.map, 0.0)) cutter.Cut(chain);
  RunsBeside beside = std::move(cutter.beside());
  std::ranges::stable_sort(beside.runs, std::ranges::greater{}, [](const TrackRun& run) {
    return run.points_m.back().x() - run.points_m.front().x();
  });
  beside.runs = InOrderOfMeetings(std::move(beside.runs));
  return beside;
}

double SpeedOfRun_kmph(const TrackRun& run, double s_m) {
  const auto way = std::ranges::partition_point(
      run.ways, [&](const LineStretch& one) { return one.end_s_m <= s_m; });
  const auto i = static_cast<std::size_t>(way - run.ways.begin());
  return run.speeds_kmph[std::min(i, run.speeds_kmph.size() - 1)];
}

double OffsetOf_m(std::span<const Eigen::Vector2d> points_m, double s_m) {
  std::size_t i = 1;
  while (i + 1 < points_m.size() && points_m[i].x() < s_m) ++i;
  const Eigen::Vector2d step_m = points_m[i] - points_m[i - 1];
  return points_m[i - 1].y() +
         step_m.y() / std::max(1e-9, step_m.x()) * (s_m - points_m[i - 1].x());
}

PlanModel PartOf(const PlanModel& plan, double begin_m, double end_m) {
  // By its elements: those outside are dropped, those at the ends shortened. A clothoid at an end
  // becomes an arc of its mean curvature, since an end has none.
  const PiecewiseLinear curvature = plan.Curvature();
  std::vector<AlignmentElement> elements;
  for (std::size_t i = 0; i < curvature.pieces().size(); ++i) {
    const LinearPiece& piece = curvature.pieces()[i];
    const double from_m = std::max(begin_m, piece.begin_s_m);
    const double to_m = std::min(end_m, curvature.EndOf(i));
    if (to_m - from_m < 1e-3) continue;
    const bool is_cut = from_m > piece.begin_s_m || to_m < curvature.EndOf(i);
    const bool is_clothoid = piece.begin_value != piece.end_value;
    const bool is_at_end = elements.empty() || end_m - to_m < 1e-3;
    if (is_clothoid && !is_cut && !is_at_end) {
      elements.push_back({ElementType::kClothoid, to_m - from_m, {}});
      continue;
    }
    const double mean_per_m = curvature.Value(0.5 * (from_m + to_m));
    if (mean_per_m == 0.0) {
      elements.push_back({ElementType::kStraight, to_m - from_m, {}});
    } else {
      elements.push_back({ElementType::kArc, to_m - from_m, 1.0 / mean_per_m});
    }
  }
  // A clothoid that was cut stands beside the arc or straight that it led to: between two plateaus
  // there must be a clothoid, as short as it may be.
  std::vector<AlignmentElement> joined;
  for (const AlignmentElement& element : elements) {
    const bool needs_clothoid = !joined.empty() && joined.back().type != ElementType::kClothoid &&
                                element.type != ElementType::kClothoid;
    joined.push_back(element);
    if (!needs_clothoid) continue;
    // Half of it is taken from either neighbour, so that headings behind it stay.
    AlignmentElement& before = joined[joined.size() - 2];
    const double half_m = std::min({0.005, 0.25 * before.length_m, 0.25 * element.length_m});
    before.length_m -= half_m;
    joined.back().length_m -= half_m;
    joined.insert(joined.end() - 1, {ElementType::kClothoid, 2.0 * half_m, {}});
  }
  return PlanOf({}, joined);
}

}  // namespace railcast
