#include "core/rail/catenary/independent_wires.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/rail/network/network.h"

namespace railcast {
namespace {

/// The track in which a turnout lies.
std::optional<std::size_t> TrackOfTurnout(const WorldSpec& world,
                                          const std::optional<TurnoutSpec>& turnout) {
  return turnout ? TrackIndex(world, turnout->track) : std::nullopt;
}

/// Distance of a branch's axis from that of its turnout's other track up to which its wire is
/// lifted: half a pantograph of 1.95 m and the largest stagger.
constexpr double kBesideOther_m = 1.4;

double CrossInPlan(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

WireAxis::WireAxis(const WorldTracks& tracks, std::size_t track) {
  const std::vector<TrackSpec>& specs = tracks.world.tracks;
  for (std::optional<std::size_t> at = track; at;
       at = TrackOfTurnout(tracks.world, specs[*at].begin)) {
    const double end_s_m =
        sections_.empty() ? tracks.courses[*at].end_s_m() : sections_.back().course->begin_s_m();
    sections_.push_back({&tracks.courses[*at], end_s_m});
  }
  std::ranges::reverse(sections_);
  for (auto at = TrackOfTurnout(tracks.world, specs[track].end); at;
       at = TrackOfTurnout(tracks.world, specs[*at].end)) {
    sections_.push_back({&tracks.courses[*at], tracks.courses[*at].end_s_m()});
  }
  sections_.back().end_s_m = std::numeric_limits<double>::infinity();
}

const TrackCourse& WireAxis::CourseAt(double s_m) const {
  return *std::ranges::find_if(sections_, [&](const Section& section) {
            return s_m <= section.end_s_m;
          })->course;
}

double WireAxis::OffsetAt_m(double s_m) const {
  return CourseAt(s_m).OffsetWithin_m(s_m);
}

double WireAxis::LiftAt_m(const Alignment& alignment, double s_m) const {
  const TrackCourse& course = CourseAt(s_m);
  return course.LiftAt(alignment, std::clamp(s_m, course.begin_s_m(), course.end_s_m())).h_m;
}

std::optional<double> StaggerInCurve(const CatenarySpec& spec, double curvature_per_m) {
  const double rise_m = spec.max_span_m * spec.max_span_m * std::abs(curvature_per_m) / 8.0;
  if (rise_m <= 0.5 * spec.stagger_m) return std::nullopt;
  return curvature_per_m > 0.0 ? -spec.stagger_m : spec.stagger_m;
}

double PantographShift_m(const CatenarySpec& spec, const AxisPoint& axis) {
  return -spec.contact_height_m * std::sin(axis.cant_rad);
}

Transform WorldFromSupport(const Alignment& alignment,
                           const WorldSpec& spec,
                           const AxisOffset& axis,
                           double s_m) {
  const double height_m = spec.catenary.contact_height_m;
  const Vector3 contact_m = alignment.WorldFromTrack(s_m, axis.d_m) * Vector3(0.0, 0.0, height_m);
  return MakeTransform(RotationFromYawPitchRoll(alignment.At(s_m).heading_rad, 0.0, 0.0),
                       contact_m + (axis.lift_m - height_m) * Vector3::UnitZ());
}

bool FollowsAlignment(const TrackSpec& track, const TrackCourse& course) {
  return course.is_parallel() && !track.begin && !track.end;
}

bool HasWireAt(const TrackSpec& track, const TrackCourse& course, double s_m) {
  return track.electrified && course.begin_s_m() <= s_m && s_m <= course.end_s_m();
}

IndependentWires::IndependentWires(const WorldTracks& tracks, const Alignment& alignment)
    : tracks_(tracks),
      alignment_(alignment),
      step_m_(tracks.world.catenary.max_span_m / static_cast<double>(kStepsOfASpan)) {
  const std::vector<TrackSpec>& specs = tracks.world.tracks;
  for (const TrackSpec& track : specs) {
    turnouts_.push_back(
        {TrackOfTurnout(tracks.world, track.begin), TrackOfTurnout(tracks.world, track.end)});
    axes_.emplace_back(tracks, axes_.size());
  }
  for (std::size_t k = 0; k < specs.size(); ++k) {
    if (!specs[k].electrified || FollowsAlignment(specs[k], tracks.courses[k])) continue;
    own_.push_back(SampledCourse(k));
  }
  std::ranges::stable_sort(own_, {}, [&](const Own& own) { return DepthOf(own.track); });
}

IndependentWires::Own IndependentWires::SampledCourse(std::size_t track) const {
  const TrackCourse& course = tracks_.courses[track];
  const double height_m = tracks_.world.catenary.contact_height_m;
  const double end_s_m = std::min(course.end_s_m(), alignment_.length_m());
  Own own{.track = track,
          .first_sample =
              static_cast<std::ptrdiff_t>(std::ceil(std::max(0.0, course.begin_s_m()) / step_m_)),
          .samples = {}};
  for (auto i = own.first_sample; static_cast<double>(i) * step_m_ <= end_s_m; ++i) {
    const Transform frame =
        course.WorldFromTrack(alignment_, static_cast<double>(i) * step_m_, 0.0, height_m);
    const Eigen::Vector2d left = frame.linear().col(1).head<2>();
    own.samples.push_back({frame.translation().head<2>(), left.normalized()});
  }
  return own;
}

std::size_t IndependentWires::DepthOf(std::size_t track) const {
  std::size_t depth = 0;
  for (const auto& other : {turnouts_[track].begin, turnouts_[track].end}) {
    if (other) depth = std::max(depth, 1 + DepthOf(*other));
  }
  return depth;
}

bool IndependentWires::HangsIn(std::size_t track, double first_s_m, double last_s_m) const {
  const TrackCourse& course = tracks_.courses[track];
  const bool begins =
      course.begin_s_m() <= first_s_m || (turnouts_[track].begin && course.begin_s_m() < last_s_m);
  const bool ends =
      last_s_m <= course.end_s_m() || (turnouts_[track].end && first_s_m < course.end_s_m());
  return begins && ends;
}

bool IndependentWires::HangIn(double first_s_m, double last_s_m) const {
  return std::ranges::any_of(
      own_, [&](const Own& own) { return HangsIn(own.track, first_s_m, last_s_m); });
}

HungWire IndependentWires::WireInPlan(std::size_t track, double s_m, double stagger_m) const {
  HungWire wire{.track = track, .axis_d_m = axes_[track].OffsetAt_m(s_m), .stagger_m = stagger_m};
  for (const auto& other : {turnouts_[track].begin, turnouts_[track].end}) {
    if (other && std::abs(wire.axis_d_m - axes_[*other].OffsetAt_m(s_m)) < kBesideOther_m) {
      wire.is_lifted = true;
    }
  }
  return wire;
}

HungWire IndependentWires::WireAt(std::size_t track, double s_m, double stagger_m) const {
  HungWire wire = WireInPlan(track, s_m, stagger_m);
  wire.axis_lift_m = axes_[track].LiftAt_m(alignment_, s_m);
  return wire;
}

const IndependentWires::Hanger& IndependentWires::HangerAt(std::size_t track,
                                                           double s_m,
                                                           KnownHangers& known) const {
  const auto found = known.find({s_m, track});
  if (found != known.end()) return found->second;
  const WorldSpec& world = tracks_.world;
  const HungWire wire = WireInPlan(track, s_m, 0.0);
  const double curvature_per_m = tracks_.courses[track].CurvatureAt(alignment_, s_m);
  return known
      .emplace(
          std::pair(s_m, track),
          Hanger{.wire = wire,
                 .world_from_support = WorldFromSupport(alignment_, world, {wire.axis_d_m}, s_m),
                 .curve_stagger_m = StaggerInCurve(world.catenary, curvature_per_m)})
      .first->second;
}

std::vector<double> IndependentWires::CandidatesAt(const Hanger& hanger, double before_m) const {
  const double usual_m = tracks_.world.catenary.stagger_m;
  const double best_m = hanger.curve_stagger_m.value_or(before_m > 0.0 ? -usual_m : usual_m);
  return {best_m, 0.5 * best_m, 0.0, -0.5 * best_m, -best_m};
}

/// The wires of a span while their staggers are chosen, one after the other.
class IndependentWires::Trial {
 public:
  Trial(const IndependentWires& wires, const SpanTrial& span, const WireRules& rules)
      : wires_(wires), span_(span), rules_(rules) {
    const WorldTracks& tracks = wires.tracks_;
    for (std::size_t k = 0; k < tracks.courses.size(); ++k) {
      const TrackSpec& track = tracks.world.tracks[k];
      const TrackCourse& course = tracks.courses[k];
      if (!FollowsAlignment(track, course) || !HasWireAt(track, course, span.first_s_m) ||
          !HasWireAt(track, course, span.last_s_m)) {
        continue;
      }
      const double first_m = course.OffsetWithin_m(span.first_s_m);
      const double last_m = course.OffsetWithin_m(span.last_s_m);
      placed_.push_back(
          {first_m + last_m, first_m + span.first_stagger_m, last_m + span.last_stagger_m});
    }
  }

  /// A track's wire at both ends of the span.
  struct Ends {
    const Hanger& first;
    const Hanger& last;
  };

  /// Takes the first staggers out of two lists that keep the rules.
  [[nodiscard]] std::optional<std::pair<double, double>> Choose(
      const Own& own,
      const Ends& ends,
      const std::vector<double>& firsts_m,
      const std::vector<double>& lasts_m) {
    const double first_axis_m = ends.first.wire.axis_d_m;
    const double last_axis_m = ends.last.wire.axis_d_m;
    for (const double first_m : firsts_m) {
      for (const double last_m : lasts_m) {
        const Placed placed{first_axis_m + last_axis_m, first_axis_m + first_m,
                            last_axis_m + last_m};
        if (!IsApart(placed)) continue;
        if (!StaysWithin(own, PlaceOf(ends.first, first_m), PlaceOf(ends.last, last_m))) continue;
        placed_.push_back(placed);
        return std::pair(first_m, last_m);
      }
    }
    return std::nullopt;
  }

 private:
  /// A wire at both ends of the span, left of the alignment.
  struct Placed {
    double axes_m{};  ///< Sum of the offsets of its axis.
    double first_d_m{};
    double last_d_m{};
  };

  /// Wires are straight in plan, so they are nearest at an end. Each lies on its track's side of
  /// the other even where a turnout has not yet parted the two: it could not pass over later.
  [[nodiscard]] bool IsApart(const Placed& wire) const {
    if (rules_.apart_m <= 0.0) return true;
    // 0.2 m between 4.4 and 4.6 m is less by rounding.
    const double apart_m = rules_.apart_m - 1e-9;
    return std::ranges::all_of(placed_, [&](const Placed& other) {
      const double side = wire.axes_m < other.axes_m ? -1.0 : 1.0;
      return side * (wire.first_d_m - other.first_d_m) >= apart_m &&
             side * (wire.last_d_m - other.last_d_m) >= apart_m;
    });
  }

  [[nodiscard]] Eigen::Vector2d PlaceOf(const Hanger& hanger, double stagger_m) const {
    const double height_m = wires_.tracks_.world.catenary.contact_height_m;
    const Vector3 place_m = hanger.world_from_support * Vector3(0.0, stagger_m, height_m);
    return place_m.head<2>();
  }

  [[nodiscard]] bool StaysWithin(const Own& own,
                                 const Eigen::Vector2d& first_m,
                                 const Eigen::Vector2d& last_m) const {
    const Eigen::Vector2d way = last_m - first_m;
    const auto sample_at = [&](double s_m) {
      return static_cast<std::ptrdiff_t>(std::lround(s_m / wires_.step_m_)) - own.first_sample;
    };
    const auto begin = std::max<std::ptrdiff_t>(0, sample_at(span_.first_s_m));
    const auto end = std::min(std::ssize(own.samples), sample_at(span_.last_s_m) + 1);
    for (auto i = begin; i < end; ++i) {
      const Pantograph& at = own.samples[static_cast<std::size_t>(i)];
      const double off_m = CrossInPlan(way, first_m - at.middle_m) / CrossInPlan(way, at.left);
      if (std::abs(off_m) > rules_.reach_m) return false;
    }
    return true;
  }

  const IndependentWires& wires_;
  const SpanTrial& span_;
  const WireRules& rules_;
  std::vector<Placed> placed_;
};

std::optional<IndependentWires::SpanStaggers> IndependentWires::Place(const SpanTrial& span,
                                                                      const Staggers& first,
                                                                      const WireRules& rules,
                                                                      KnownHangers& known) const {
  SpanStaggers chosen(tracks_.courses.size());
  Trial trial(*this, span, rules);
  for (const Own& own : own_) {
    if (!HangsIn(own.track, span.first_s_m, span.last_s_m)) continue;
    const Trial::Ends ends{HangerAt(own.track, span.first_s_m, known),
                           HangerAt(own.track, span.last_s_m, known)};
    const std::optional<double>& known_m = first[own.track];
    const std::vector<double> firsts_m =
        known_m ? std::vector{*known_m} : CandidatesAt(ends.first, span.last_stagger_m);
    const std::vector<double> lasts_m =
        CandidatesAt(ends.last, known_m.value_or(span.first_stagger_m));
    chosen[own.track] = trial.Choose(own, ends, firsts_m, lasts_m);
    if (!chosen[own.track]) return std::nullopt;
  }
  return chosen;
}

}  // namespace railcast
