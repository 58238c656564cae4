#include "core/rail/catenary/catenary_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <variant>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {
namespace {

constexpr std::size_t kStepsOfASpan = 26;
constexpr double kLateralMargin_m = 0.05;
constexpr double kShortestDropper_m = 0.3;
/// Minimum length of the last span; a shorter remainder of the line has no wire.
constexpr double kShortestSpan_m = 5.0;

/// The axis from a support onwards, sampled every max_span / 26.
struct Course {
  std::array<double, kStepsOfASpan + 1> curvature_per_m{};
  /// c(s): lateral position of a pantograph's middle relative to the tangent at the support.
  std::array<double, kStepsOfASpan + 1> lateral_m{};
};

Course CourseFrom(double s_m, const CatenarySpec& spec, const Alignment& alignment) {
  const double step_m = spec.max_span_m / static_cast<double>(kStepsOfASpan);
  Course course;
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

bool StaysWithin(const Course& course,
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

/// Stagger towards the outside of a curve; nothing where the line is straight enough for staggers
/// to alternate.
std::optional<double> StaggerInCurve(const CatenarySpec& spec, double curvature_per_m) {
  const double rise_m = spec.max_span_m * spec.max_span_m * std::abs(curvature_per_m) / 8.0;
  if (rise_m <= 0.5 * spec.stagger_m) return std::nullopt;
  return curvature_per_m > 0.0 ? -spec.stagger_m : spec.stagger_m;
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

/// The farthest support that the wire permits; nearer if that one would stand in a road.
CatenarySupport NextSupport(const CatenarySupport& support,
                            const WorldSpec& world,
                            const Alignment& alignment) {
  const CatenarySpec& spec = world.catenary;
  // The 1e-9 covers rounding if a span at the limit is compared with the limit itself.
  const double limit_m = spec.stagger_m + kLateralMargin_m + 1e-9;
  const Course course = CourseFrom(support.s_m, spec, alignment);
  std::optional<CatenarySupport> in_road;
  for (std::size_t num_steps = kStepsOfASpan; num_steps > 0; --num_steps) {
    const double s_m = support.s_m + spec.max_span_m * static_cast<double>(num_steps) /
                                         static_cast<double>(kStepsOfASpan);
    const std::optional<double> outside_m = StaggerInCurve(spec, course.curvature_per_m[num_steps]);
    const double stagger_m = outside_m.value_or(-support.stagger_m);
    if (!StaysWithin(course, num_steps, support.stagger_m, stagger_m, limit_m)) continue;
    const CatenarySupport next{.s_m = s_m, .stagger_m = stagger_m};
    if (!StandsInRoad(world, s_m)) return next;
    if (!in_road) in_road = next;
  }
  Check(in_road.has_value(), "a wire between neighbouring samples is within its staggers");
  return *in_road;
}

bool HasContactLine(const WorldSpec& spec) {
  return spec.catenary.enabled &&
         std::any_of(spec.tracks.begin(), spec.tracks.end(),
                     [](const TrackSpec& track) { return track.electrified; });
}

}  // namespace

double LeastSystemHeight_m(const WorldSpec& world) {
  const CatenarySpec& spec = world.catenary;
  const double sag_m =
      kWireWeight_n_per_m * spec.max_span_m * spec.max_span_m / (8.0 * kMessengerTension_n);
  return sag_m - kContactPresag * spec.max_span_m + kShortestDropper_m;
}

void CheckSystemHeight(const WorldSpec& world) {
  if (!HasContactLine(world)) return;
  const CatenarySpec& spec = world.catenary;
  const double needed_m = LeastSystemHeight_m(world);
  if (spec.system_height_m >= needed_m) return;
  throw InputError({{"/catenary/system_height_m",
                     "must be >= " + NumberText(needed_m) +
                         ", the messenger's sag over max_span_m and a shortest dropper",
                     NumberText(spec.system_height_m)}});
}

CatenaryPlan::CatenaryPlan(const WorldSpec& spec, const Alignment& alignment) {
  if (!HasContactLine(spec)) return;
  CheckSystemHeight(spec);
  const double first_m = StaggerInCurve(spec.catenary, alignment.At(0.0).curvature_per_m)
                             .value_or(spec.catenary.stagger_m);
  supports_.push_back({.s_m = 0.0, .stagger_m = first_m});
  while (true) {
    CatenarySupport next = NextSupport(supports_.back(), spec, alignment);
    if (next.s_m >= alignment.length_m()) {
      const double left_m = alignment.length_m() - supports_.back().s_m;
      next.s_m = alignment.length_m();
      if (left_m >= kShortestSpan_m) supports_.push_back(next);
      return;
    }
    supports_.push_back(next);
  }
}

double PantographShift_m(const CatenarySpec& spec, const AxisPoint& axis) {
  return -spec.contact_height_m * std::sin(axis.cant_rad);
}

Transform WorldFromSupport(const Alignment& alignment,
                           const WorldSpec& spec,
                           double track_d_m,
                           double s_m) {
  const double height_m = spec.catenary.contact_height_m;
  const Vector3 contact_m = alignment.WorldFromTrack(s_m, track_d_m) * Vector3(0.0, 0.0, height_m);
  return MakeTransform(RotationFromYawPitchRoll(alignment.At(s_m).heading_rad, 0.0, 0.0),
                       contact_m - height_m * Vector3::UnitZ());
}

}  // namespace railcast
