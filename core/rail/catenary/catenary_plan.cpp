#include "core/rail/catenary/catenary_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/rail/clearance/tunnel_shape.h"

namespace railcast {
namespace {

constexpr double kLateralMargin_m = 0.05;
/// Working half width of a pantograph's head of 1950 mm, and distances between two wires in plan.
constexpr double kWorkingHalfWidth_m = 0.55;
constexpr double kWiresApart_m = 0.2;
constexpr double kLeastApart_m = 0.1;
/// Minimum length of the last span; a shorter remainder of the line has no wire.
constexpr double kShortestSpan_m = 5.0;

/// The axis from a support onwards, sampled every max_span / 26.
struct WireCourse {
  std::array<double, kStepsOfASpan + 1> curvature_per_m{};
  /// c(s): lateral position of a pantograph's middle relative to the tangent at the support.
  std::array<double, kStepsOfASpan + 1> lateral_m{};
};

WireCourse CourseFrom(double s_m, const CatenarySpec& spec, const Alignment& alignment) {
  const double step_m = spec.max_span_m / static_cast<double>(kStepsOfASpan);
  WireCourse course;
  double heading_rad = 0.0;
  double axis_m = 0.0;
  double previous_per_m = 0.0;
  for (std::size_t i = 0; i <= kStepsOfASpan; ++i) {
    const AxisPoint axis = alignment.At(s_m + step_m * static_cast<double>(i));
    if (i > 0) {
      // Exact if the curvature is linear over the step.
      axis_m += heading_rad * step_m +
                (2.0 * previous_per_m + axis.curvature_per_m) * step_m * step_m / 6.0;
      heading_rad += 0.5 * (previous_per_m + axis.curvature_per_m) * step_m;
    }
    previous_per_m = axis.curvature_per_m;
    course.curvature_per_m[i] = axis.curvature_per_m;
    course.lateral_m[i] = axis_m + PantographShift_m(spec, axis);
  }
  return course;
}

bool StaysWithin(const WireCourse& course,
                 std::size_t num_steps,
                 double first_stagger_m,
                 double last_stagger_m,
                 double limit_m) {
  const double first_m = course.lateral_m[0] + first_stagger_m;
  const double last_m = course.lateral_m[num_steps] + last_stagger_m;
  for (std::size_t i = 0; i <= num_steps; ++i) {
    const double fraction = static_cast<double>(i) / static_cast<double>(num_steps);
    if (std::abs(std::lerp(first_m, last_m, fraction) - course.lateral_m[i]) > limit_m)
      return false;
  }
  return true;
}

/// Whether a mast at that chainage would stand in the road of a level crossing or in its shoulders.
bool StandsInRoad(const WorldSpec& world, double s_m) {
  constexpr double kBesideRoad_m = 1.5;
  return std::any_of(
      world.structures.begin(), world.structures.end(), [&](const StructureSpec& structure) {
        const auto* crossing = std::get_if<LevelCrossingSpec>(&structure);
        return crossing != nullptr &&
               std::abs(s_m - crossing->s_m) < 0.5 * crossing->road_width_m + kBesideRoad_m;
      });
}

/// A support with the staggers of the tracks that do not follow the alignment, there and along the
/// span before it.
struct PlannedSupport {
  CatenarySupport support;
  IndependentWires::Staggers own;
  IndependentWires::SpanStaggers span_before;
  bool is_relaxed{};  ///< Whether the span before it does not keep the first of the rules.
};

/// Finds one support after the other.
class SupportSearch {
 public:
  SupportSearch(const WorldTracks& tracks, const Alignment& alignment)
      : world_(tracks.world), alignment_(alignment), own_(tracks, alignment) {}

  /// The farthest support that the wires permit; nearer if that one would stand in a road.
  [[nodiscard]] PlannedSupport After(const PlannedSupport& from) {
    known_.erase(known_.begin(), known_.lower_bound({from.support.s_m, 0}));
    courses_.erase(courses_.begin(), courses_.lower_bound(from.support.s_m));
    // Beyond a support it must go on, too: two spans ahead are enough to begin at a turnout.
    constexpr int kSpansAhead = 2;
    const double limit_m = world_.catenary.stagger_m + kLateralMargin_m;
    for (const WireRules& rules : {WireRules{limit_m, kWiresApart_m},
                                   WireRules{std::max(kWorkingHalfWidth_m, limit_m), kLeastApart_m},
                                   WireRules{std::max(kWorkingHalfWidth_m, limit_m), 0.0},
                                   WireRules{std::numeric_limits<double>::infinity(), 0.0}}) {
      auto next = Next(from, rules, kSpansAhead);
      if (!next) continue;
      next->is_relaxed = rules.apart_m < kWiresApart_m;
      return *std::move(next);
    }
    Check(false, "a wire between neighbouring samples is within its staggers");
    return from;
  }

 private:
  [[nodiscard]] std::optional<PlannedSupport> Next(const PlannedSupport& from,
                                                   const WireRules& rules,
                                                   int num_spans_ahead) {
    const CatenarySpec& spec = world_.catenary;
    // The 1e-9 covers rounding if a span at the limit is compared with the limit itself.
    const double limit_m = spec.stagger_m + kLateralMargin_m + 1e-9;
    const double first_m = from.support.stagger_m;
    const WireCourse& course = CourseOf(from.support.s_m);
    std::optional<PlannedSupport> in_road;
    for (std::size_t num_steps = kStepsOfASpan; num_steps > 0; --num_steps) {
      const double s_m = from.support.s_m + spec.max_span_m * static_cast<double>(num_steps) /
                                                static_cast<double>(kStepsOfASpan);
      const double best_m =
          StaggerInCurve(spec, course.curvature_per_m[num_steps]).value_or(-first_m);
      const bool has_own = own_.HangIn(from.support.s_m, std::min(s_m, alignment_.length_m()));
      for (const double stagger_m : has_own ? std::vector{best_m, -best_m} : std::vector{best_m}) {
        if (!StaysWithin(course, num_steps, first_m, stagger_m, limit_m)) continue;
        auto next = WithIndependentWires(from, {.s_m = s_m, .stagger_m = stagger_m}, rules);
        if (!next || !GoesOn(*next, rules, num_spans_ahead)) continue;
        if (!StandsInRoad(world_, s_m)) return next;
        if (!in_road) in_road = std::move(next);
      }
    }
    return in_road;
  }

  [[nodiscard]] const WireCourse& CourseOf(double s_m) {
    const auto found = courses_.find(s_m);
    if (found != courses_.end()) return found->second;
    return courses_.emplace(s_m, CourseFrom(s_m, world_.catenary, alignment_)).first->second;
  }

  [[nodiscard]] bool GoesOn(const PlannedSupport& from,
                            const WireRules& rules,
                            int num_spans_ahead) {
    const double s_m = from.support.s_m;
    const double ahead_s_m = std::min(s_m + world_.catenary.max_span_m, alignment_.length_m());
    if (num_spans_ahead == 0 || s_m >= alignment_.length_m()) return true;
    return !own_.HangIn(s_m, ahead_s_m) || Next(from, rules, num_spans_ahead - 1).has_value();
  }

  [[nodiscard]] std::optional<PlannedSupport> WithIndependentWires(const PlannedSupport& from,
                                                                   const CatenarySupport& to,
                                                                   const WireRules& rules) {
    PlannedSupport next{.support = to, .own = {}, .span_before = {}, .is_relaxed = false};
    auto staggers = own_.Place({.first_s_m = from.support.s_m,
                                .last_s_m = std::min(to.s_m, alignment_.length_m()),
                                .first_stagger_m = from.support.stagger_m,
                                .last_stagger_m = to.stagger_m},
                               from.own, rules, known_);
    if (!staggers) return std::nullopt;
    for (const auto& span : *staggers) {
      next.own.push_back(span ? std::optional(span->second) : std::nullopt);
    }
    next.span_before = *std::move(staggers);
    return next;
  }

  const WorldSpec& world_;
  const Alignment& alignment_;
  IndependentWires own_;
  // What was computed behind the last support: supports are tried again and again.
  IndependentWires::KnownHangers known_;
  std::map<double, WireCourse> courses_;
};

}  // namespace

CatenaryPlan::CatenaryPlan(const WorldTracks& tracks, const Alignment& alignment)
    : independent_wires_(tracks.courses.size()) {
  const WorldSpec& spec = tracks.world;
  if (!HasContactLine(spec)) return;
  CheckSystemHeight(spec);
  const IndependentWires own(tracks, alignment);
  SupportSearch search(tracks, alignment);
  const double first_m = StaggerInCurve(spec.catenary, alignment.At(0.0).curvature_per_m)
                             .value_or(spec.catenary.stagger_m);
  PlannedSupport last{.support = {.s_m = 0.0, .stagger_m = first_m},
                      .own = IndependentWires::Staggers(tracks.courses.size()),
                      .span_before = {},
                      .is_relaxed = false};
  supports_.push_back(last.support);
  while (last.support.s_m < alignment.length_m()) {
    PlannedSupport next = search.After(last);
    if (next.support.s_m >= alignment.length_m()) {
      if (alignment.length_m() - last.support.s_m < kShortestSpan_m) return;
      next.support.s_m = alignment.length_m();
    }
    supports_.push_back(next.support);
    if (next.is_relaxed) ++num_relaxed_spans_;
    for (std::size_t k = 0; k < independent_wires_.size(); ++k) {
      if (!next.span_before[k]) continue;
      IndependentWire& wire = independent_wires_[k];
      if (wire.at.empty()) {
        wire.first_support = supports_.size() - 2;
        wire.at.push_back(own.WireAt(k, last.support.s_m, next.span_before[k]->first));
      }
      wire.at.push_back(own.WireAt(k, next.support.s_m, next.span_before[k]->second));
    }
    last = std::move(next);
  }
}

std::vector<HungWire> CatenaryPlan::WiresAt(const WorldTracks& tracks, std::size_t support) const {
  const CatenarySupport& at = supports_[support];
  std::vector<HungWire> wires;
  for (std::size_t k = 0; k < tracks.courses.size(); ++k) {
    const TrackSpec& track = tracks.world.tracks[k];
    const TrackCourse& course = tracks.courses[k];
    const IndependentWire& own = independent_wires_[k];
    if (FollowsAlignment(track, course)) {
      if (!HasWireAt(track, course, at.s_m)) continue;
      wires.push_back({k, course.OffsetWithin_m(at.s_m), at.stagger_m, false});
    } else if (!own.at.empty() && own.first_support <= support && support <= own.last_support()) {
      wires.push_back(own.at[support - own.first_support]);
    }
  }
  return wires;
}

}  // namespace railcast
