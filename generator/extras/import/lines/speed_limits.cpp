#include "generator/extras/import/lines/speed_limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string_view>

#include "core/rail/line/alignment_course.h"
#include "generator/extras/import/fit/plan_model.h"
#include "generator/extras/import/lines/line_tags.h"

namespace railcast {
namespace {

/// Speed on tracks with a `service`: sidings, yards, crossovers, spurs.
constexpr double kService_kmph = 40.0;

/// What a value of `railway` or `usage` usually means.
struct UsualSpeed {
  std::string_view value;
  double speed_kmph{};
};
constexpr auto kUsualSpeeds = std::to_array<UsualSpeed>({{"tram", 50.0},
                                                         {"subway", 80.0},
                                                         {"light_rail", 80.0},
                                                         {"narrow_gauge", 60.0},
                                                         {"preserved", 40.0},
                                                         {"tourism", 40.0},
                                                         {"industrial", 40.0},
                                                         {"military", 40.0},
                                                         {"test", 40.0}});

/// Arcs that are flatter hold back no train.
constexpr double kLeastArc_per_m = 1e-6;
constexpr double kSpeedStep_kmph = 5.0;
/// Share of the radius that a speed needs: a fitted arc may be that much sharper than the track.
constexpr double kLeastShareOfRadius = 0.8;

/// An arc with its clothoids.
struct SpeedOfArc {
  double begin_s_m{};
  double end_s_m{};
  double radius_m{};
  double speed_kmph{};
};

std::vector<SpeedOfArc> ArcsOf(const PlanModel& plan) {
  std::vector<SpeedOfArc> arcs;
  double middle_s_m = 0.0;  // Middle of the clothoid before the plateau.
  for (std::size_t i = 0; i < plan.plateaus.size(); ++i) {
    const Plateau& plateau = plan.plateaus[i];
    const double before_m = i > 0 ? plan.clothoids_m[i - 1] : 0.0;
    const double behind_m = i < plan.clothoids_m.size() ? plan.clothoids_m[i] : 0.0;
    const double begin_s_m = middle_s_m - 0.5 * before_m;
    middle_s_m += plateau.length_m;
    if (std::abs(plateau.curvature_per_m) <= kLeastArc_per_m) continue;
    const double radius_m = 1.0 / std::abs(plateau.curvature_per_m);
    const double steps = std::floor(SpeedInArc_kmph(radius_m) / kSpeedStep_kmph);
    arcs.push_back(
        {begin_s_m, middle_s_m + 0.5 * behind_m, radius_m, kSpeedStep_kmph * std::max(1.0, steps)});
  }
  return arcs;
}

/// Whether an arc holds trains back from a speed. One that the map has may ask for somewhat more
/// than the arc allows.
bool IsSlower(const SpeedOfArc& arc, const StepSpeed& speed) {
  if (!speed.is_mapped) return arc.speed_kmph < speed.speed_kmph;
  return arc.radius_m < kLeastShareOfRadius / SharpestCurvature_per_m(speed.speed_kmph);
}

constexpr double kShortestLimit_m = 50.0;

/// Takes limits that are the same as those before them out.
void JoinEqualLimits(std::vector<ChainageValue>& limits) {
  const auto is_same = [](const ChainageValue& a, const ChainageValue& b) {
    return a.value == b.value;
  };
  // clang 14 cannot compile std::ranges::unique.
  limits.erase(std::unique(limits.begin(), limits.end(), is_same), limits.end());
}

/// Lets no limit end within a stretch, and none be above another limit there.
void LimitWithin(double begin_m,
                 double end_m,
                 double most_kmph,
                 std::vector<ChainageValue>& limits) {
  for (const double at_m : {begin_m, end_m}) {
    const auto next = std::ranges::lower_bound(limits, at_m, {}, &ChainageValue::s_m);
    if (next == limits.begin() || (next != limits.end() && next->s_m == at_m)) continue;
    limits.insert(next, {at_m, std::prev(next)->value});
  }
  for (ChainageValue& limit : limits) {
    if (limit.s_m >= begin_m && limit.s_m < end_m) limit.value = std::min(limit.value, most_kmph);
  }
  JoinEqualLimits(limits);
}

/// Lets each limit hold for kShortestLimit_m or more, and raises none.
void LengthenShort(double length_m, std::vector<ChainageValue>& limits) {
  while (limits.size() > 1) {
    const auto end_m = [&](std::size_t i) {
      return i + 1 < limits.size() ? limits[i + 1].s_m : length_m;
    };
    std::size_t shortest = 0;
    for (std::size_t i = 1; i < limits.size(); ++i) {
      if (end_m(i) - limits[i].s_m < end_m(shortest) - limits[shortest].s_m) shortest = i;
    }
    const ChainageValue limit = limits[shortest];
    const double missing_m = kShortestLimit_m - (end_m(shortest) - limit.s_m);
    constexpr double kRounding_m = 0.2;
    if (missing_m <= kRounding_m) return;
    double slower_kmph = 0.0;
    if (shortest > 0 && limits[shortest - 1].value < limit.value) {
      slower_kmph = limits[shortest - 1].value;
    }
    if (shortest + 1 < limits.size() && limits[shortest + 1].value < limit.value) {
      slower_kmph = std::max(slower_kmph, limits[shortest + 1].value);
    }
    if (slower_kmph > 0.0) {
      limits[shortest].value = slower_kmph;
      JoinEqualLimits(limits);
      continue;
    }
    // In tenths of a metre, as all limits.
    const double begin_m = std::max(0.0, std::min(RoundedTo(limit.s_m - 0.5 * missing_m, 10.0),
                                                  RoundedTo(length_m - kShortestLimit_m, 10.0)));
    const double to_m = std::min(length_m, begin_m + kShortestLimit_m);
    LimitWithin(begin_m, length_m - to_m < 0.1 ? length_m : to_m, limit.value, limits);
    std::erase_if(limits, [&](const ChainageValue& one) { return one.s_m >= length_m; });
  }
}

}  // namespace

double UsualSpeed_kmph(const MapTags& tags, double running_kmph) {
  if (!TagOf(tags, "service").empty()) return kService_kmph;
  const std::string_view railway = TagOf(tags, "railway");
  const std::string_view usage = TagOf(tags, "usage");
  for (const UsualSpeed& usual : kUsualSpeeds) {
    if (railway == usual.value || usage == usual.value) return usual.speed_kmph;
  }
  return running_kmph;
}

double SpeedInArc_kmph(double radius_m) {
  static const AlignmentSpec rule;  // Has the limits of cants.
  constexpr double kWithoutCant_m = 50.0;
  constexpr double kRadiusOfCant_mPerMm = 1.5;
  const double cant_mm =
      std::clamp((radius_m - kWithoutCant_m) / kRadiusOfCant_mPerMm, 0.0, rule.cant_max_mm);
  return std::sqrt(radius_m * (rule.cant_deficiency_mm + cant_mm) / kBalancingCant);
}

std::vector<StepSpeed> SpeedsAlong(const RailMap& map, const TrackLine& line, double running_kmph) {
  std::vector<std::optional<double>> given;
  std::vector<double> middle_m;  // Along the line.
  double along_m = 0.0;
  for (std::size_t i = 0; i < line.ways.size(); ++i) {
    given.push_back(SpeedOf_kmph(map.ways[line.ways[i]].tags));
    const double length_m = StepLength_m(map, line, i);
    middle_m.push_back(along_m + 0.5 * length_m);
    along_m += length_m;
  }
  std::vector<StepSpeed> speeds;
  for (std::size_t i = 0; i < given.size(); ++i) {
    std::optional<std::size_t> nearest;
    const auto consider = [&](std::size_t other) {
      const auto distance_m = [&](std::size_t way) {
        return std::abs(middle_m[way] - middle_m[i]);
      };
      if (!nearest || distance_m(other) < distance_m(*nearest)) nearest = other;
    };
    for (std::size_t before = i + 1; before-- > 0;) {
      if (!given[before]) continue;
      consider(before);
      break;
    }
    for (std::size_t after = i; after < given.size(); ++after) {
      if (!given[after]) continue;
      consider(after);
      break;
    }
    speeds.push_back(
        {nearest ? *given[*nearest] : UsualSpeed_kmph(map.ways[line.ways[i]].tags, running_kmph),
         given[i].has_value()});
  }
  return speeds;
}

std::vector<double> SpeedsOfCurves_kmph(const std::vector<Eigen::Vector2d>& places_m,
                                        const std::vector<double>& along_m) {
  constexpr double kArm_m = 50.0;
  const auto place_m = [&](double at_m) -> Eigen::Vector2d {
    const auto after = std::ranges::upper_bound(along_m, at_m);
    const auto next = std::clamp<std::ptrdiff_t>(after - along_m.begin(), 1,
                                                 static_cast<std::ptrdiff_t>(along_m.size()) - 1);
    const auto i = static_cast<std::size_t>(next);
    const double share = (at_m - along_m[i - 1]) / (along_m[i] - along_m[i - 1]);
    return places_m[i - 1] + share * (places_m[i] - places_m[i - 1]);
  };
  std::vector<double> speeds_kmph;
  for (std::size_t i = 0; i + 1 < places_m.size(); ++i) {
    const double arm_m = std::min(kArm_m, 0.5 * along_m.back());
    const double middle_m =
        std::clamp(0.5 * (along_m[i] + along_m[i + 1]), arm_m, along_m.back() - arm_m);
    const double curvature_per_m = CircleCurvature_per_m(
        place_m(middle_m - arm_m), place_m(middle_m), place_m(middle_m + arm_m));
    speeds_kmph.push_back(
        SpeedInArc_kmph(1.0 / std::max(kLeastArc_per_m, std::abs(curvature_per_m))));
  }
  return speeds_kmph;
}

double SpeedAt_kmph(const std::vector<ChainageValue>& limits_kmph, double s_m) {
  const auto after = std::ranges::upper_bound(limits_kmph, s_m, {}, &ChainageValue::s_m);
  return (after == limits_kmph.begin() ? limits_kmph.front() : *std::prev(after)).value;
}

std::vector<ChainageValue> SpeedLimitsOf(const std::vector<StepSpeed>& speeds,
                                         const std::vector<double>& feet_m,
                                         const PlanModel& plan) {
  // Rounded chainages differ by 0.1 m at least, and the last one must lie before the end.
  constexpr double kSteps_per_m = 10.0;
  constexpr double kNearest_m = 0.5 / kSteps_per_m;
  const std::vector<SpeedOfArc> arcs = ArcsOf(plan);
  std::vector<double> bounds_m(feet_m.begin() + 1, feet_m.end());
  for (const SpeedOfArc& arc : arcs) bounds_m.insert(bounds_m.end(), {arc.begin_s_m, arc.end_s_m});
  for (double& bound_m : bounds_m) bound_m = RoundedTo(bound_m, kSteps_per_m);
  std::erase_if(bounds_m, [&](double s_m) {
    return s_m <= kNearest_m || s_m >= plan.length_m() - kNearest_m;
  });
  std::ranges::sort(bounds_m);
  bounds_m.erase(std::unique(bounds_m.begin(), bounds_m.end()), bounds_m.end());
  bounds_m.push_back(plan.length_m());
  std::vector<ChainageValue> limits;
  std::size_t step = 0;
  auto arc = arcs.begin();
  double begin_m = 0.0;
  for (const double end_m : bounds_m) {
    const double middle_m = 0.5 * (begin_m + end_m);
    while (step + 1 < speeds.size() && feet_m[step + 1] <= middle_m) ++step;
    double speed_kmph = speeds[step].speed_kmph;
    while (arc != arcs.end() && arc->end_s_m < middle_m) ++arc;
    // The clothoid between two arcs belongs to both.
    for (auto here = arc; here != arcs.end() && here->begin_s_m <= middle_m; ++here) {
      if (!IsSlower(*here, speeds[step])) continue;
      speed_kmph = std::min(speed_kmph, here->speed_kmph);
    }
    if (limits.empty() || limits.back().value != speed_kmph)
      limits.push_back({begin_m, speed_kmph});
    begin_m = end_m;
  }
  LengthenShort(plan.length_m(), limits);
  return limits;
}

}  // namespace railcast
