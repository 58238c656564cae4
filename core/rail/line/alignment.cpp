#include "railcast/alignment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/rail/line/alignment_course.h"
#include "core/rail/line/piecewise_linear.h"
#include "core/rail/line/plan_course.h"

namespace railcast {
namespace {

constexpr double kPermil = 1e-3;
// Sampling of a spline's curvature. Used for the cant only, which is averaged over some 60 m.
constexpr double kCurvatureSampling_m = 5.0;

void CheckRules(const AlignmentSpec& spec, ErrorList& errors) {
  const auto check = [&](bool holds, const char* place, const char* rule, double value) {
    if (!holds) errors.Add({place, rule, NumberText(value)});
  };
  check(spec.curvature_smoothing_m > 0.0, "/curvature_smoothing_m", "must be > 0",
        spec.curvature_smoothing_m);
  check(spec.gradient_smoothing_m > 0.0, "/gradient_smoothing_m", "must be > 0",
        spec.gradient_smoothing_m);
  check(spec.gauge_mm >= kNarrowestGauge_mm && spec.gauge_mm <= kWidestGauge_mm, "/gauge_mm",
        "must be from 600 to 1700", spec.gauge_mm);
  check(spec.cant_ramp_m > 0.0, "/cant_ramp_m", "must be > 0", spec.cant_ramp_m);
  check(spec.cant_deficiency_mm >= 0.0, "/cant_deficiency_mm", "must be >= 0",
        spec.cant_deficiency_mm);
  check(spec.cant_max_mm >= 0.0 && spec.cant_max_mm <= 300.0, "/cant_max_mm",
        "must be from 0 to 300", spec.cant_max_mm);
  for (std::size_t i = 0; i < spec.speed_limits_kmph.size(); ++i) {
    const std::string place = "/speed_limits_kmph/" + std::to_string(i) + "/value";
    const double speed_kmph = spec.speed_limits_kmph[i].value;
    check(speed_kmph > 0.0, place.c_str(), "must be > 0", speed_kmph);
  }
  for (std::size_t i = 0; i < spec.cants_mm.size(); ++i) {
    const std::string place = "/cants_mm/" + std::to_string(i) + "/value";
    const double cant_mm = spec.cants_mm[i].value;
    check(std::abs(cant_mm) <= 300.0, place.c_str(), "must be from -300 to 300", cant_mm);
  }
}

/// A course in plan, independent of how it was specified.
struct Plan {
  std::variant<PlanCourse, PlanSpline> course;
  PiecewiseLinear curvature;  ///< For a spline: sampled.
  double tightest_radius_m{};
  std::vector<Jump> jumps;
};

Plan PlanOfCurvature(const PiecewiseLinear& given, const AlignmentSpec& spec) {
  auto [curvature, jumps] = SmoothJumps(given, spec.curvature_smoothing_m);
  const PlanPoint start{spec.origin_m[0], spec.origin_m[1], RadFromDeg(spec.heading_deg), 0.0};
  const double tightest_radius_m = 1.0 / curvature.LargestMagnitude();
  PlanCourse course(curvature, start);
  return {std::move(course), std::move(curvature), tightest_radius_m, std::move(jumps)};
}

PiecewiseLinear SampledCurvature(const PlanSpline& spline) {
  const double num_steps = std::ceil(spline.length_m() / kCurvatureSampling_m);
  std::vector<LinearPiece> pieces;
  double curvature_per_m = spline.At(0.0).curvature_per_m;
  for (double step = 0.0; step < num_steps; ++step) {
    const double next_per_m =
        spline.At(spline.length_m() * ((step + 1.0) / num_steps)).curvature_per_m;
    pieces.push_back({spline.length_m() * (step / num_steps), curvature_per_m, next_per_m});
    curvature_per_m = next_per_m;
  }
  return {std::move(pieces), spline.length_m()};
}

std::optional<Plan> PlanOfSpline(const AlignmentSplineSpec& course,
                                 const AlignmentSpec& spec,
                                 ErrorList& errors) {
  const std::size_t num_faults = errors.size();
  const Eigen::Vector2d origin_m(spec.origin_m[0], spec.origin_m[1]);
  const Eigen::Rotation2Dd world_from_plan(RadFromDeg(spec.heading_deg));
  std::vector<Eigen::Vector2d> points_m;
  for (const auto& [x_m, y_m] : course.points_m) {
    points_m.push_back(origin_m + world_from_plan * Eigen::Vector2d(x_m, y_m));
  }
  PlanSpline spline(std::move(points_m), errors);
  if (errors.size() > num_faults) return std::nullopt;
  PiecewiseLinear curvature = SampledCurvature(spline);
  const double tightest_radius_m = spline.tightest_radius_m();
  return Plan{std::move(spline), std::move(curvature), tightest_radius_m, {}};
}

std::optional<Plan> MakePlan(const AlignmentSpec& spec, ErrorList& errors) {
  if (const auto* spline = std::get_if<AlignmentSplineSpec>(&spec.course)) {
    return PlanOfSpline(*spline, spec, errors);
  }
  const std::size_t num_faults = errors.size();
  const auto* sections = std::get_if<AlignmentSectionsSpec>(&spec.course);
  const PiecewiseLinear curvature =
      sections != nullptr ? CurvatureOf(*sections, errors)
                          : CurvatureOf(std::get<AlignmentElementsSpec>(spec.course), errors);
  if (errors.size() > num_faults) return std::nullopt;
  return PlanOfCurvature(curvature, spec);
}

std::vector<SmoothedJump> Listed(const std::vector<Jump>& curvature,
                                 const std::vector<Jump>& gradient) {
  std::vector<SmoothedJump> list;
  for (const Jump& jump : curvature) {
    list.push_back({"curvature", jump.s_m, jump.before, jump.after, jump.length_m});
  }
  for (const Jump& jump : gradient) {
    list.push_back({"gradient", jump.s_m, jump.before, jump.after, jump.length_m});
  }
  return list;
}

}  // namespace

struct Alignment::Parts {
  Plan plan;
  double origin_height_m{};
  PiecewiseLinear gradient_permil;
  PiecewiseLinear speed_limit_kmph;
  bool has_speed_limits{};
  Cant cant;
  std::vector<SmoothedJump> smoothed_jumps;
};

Alignment::Alignment(const AlignmentSpec& spec) {
  ErrorList errors;
  CheckRules(spec, errors);
  std::optional<Plan> plan = MakePlan(spec, errors);
  // Without a plan, the length is unknown and chainages cannot exceed it.
  const double length_m =
      plan ? plan->curvature.end_s_m() : std::numeric_limits<double>::infinity();
  const PiecewiseLinear gradient =
      StepsOf(spec.gradients_permil, length_m, 0.0, "/gradients_permil", errors);
  PiecewiseLinear speed_kmph =
      StepsOf(spec.speed_limits_kmph, length_m, 0.0, "/speed_limits_kmph", errors);
  PiecewiseLinear surveyed_mm = LinesThrough(spec.cants_mm, length_m, "/cants_mm", errors);
  errors.ThrowIfAny();

  SmoothedFunction smooth_gradient = SmoothJumps(gradient, spec.gradient_smoothing_m);
  Cant cant = spec.cants_mm.empty() ? Cant(plan->curvature, speed_kmph, spec)
                                    : Cant(std::move(surveyed_mm), spec);
  std::vector<SmoothedJump> jumps = Listed(plan->jumps, smooth_gradient.jumps);
  parts_ = std::make_shared<const Parts>(Parts{
      std::move(*plan), spec.origin_m[2], std::move(smooth_gradient.function),
      std::move(speed_kmph), !spec.speed_limits_kmph.empty(), std::move(cant), std::move(jumps)});
}

double Alignment::length_m() const {
  return parts_->plan.curvature.end_s_m();
}

AxisPoint Alignment::At(double s_m) const {
  const double inside_s_m = std::clamp(s_m, 0.0, length_m());
  const PlanPoint plan =
      std::visit([&](const auto& course) { return course.At(inside_s_m); }, parts_->plan.course);
  AxisPoint point;
  point.position_m = {
      plan.x_m, plan.y_m,
      parts_->origin_height_m + kPermil * parts_->gradient_permil.Integral(inside_s_m)};
  point.heading_rad = plan.heading_rad;
  point.cant_rad = parts_->cant.RollRad(inside_s_m);
  if (s_m == inside_s_m) {
    point.gradient = kPermil * parts_->gradient_permil.Value(s_m);
    point.curvature_per_m = plan.curvature_per_m;
  } else {
    point.position_m +=
        (s_m - inside_s_m) * Vector3(std::cos(plan.heading_rad), std::sin(plan.heading_rad), 0.0);
  }
  return point;
}

double Alignment::SpeedLimitMps(double s_m) const {
  return parts_->has_speed_limits ? MpsFromKmph(parts_->speed_limit_kmph.Value(s_m))
                                  : std::numeric_limits<double>::infinity();
}

double Alignment::tightest_radius_m() const {
  return parts_->plan.tightest_radius_m;
}

const std::vector<SmoothedJump>& Alignment::smoothed_jumps() const {
  return parts_->smoothed_jumps;
}

Transform Alignment::WorldFromTrack(double s_m, double d_m, double h_m) const {
  const AxisPoint axis = At(s_m);
  const Eigen::Matrix3d world_from_track =
      RotationFromYawPitchRoll(axis.heading_rad, -std::atan(axis.gradient), axis.cant_rad);
  const Vector3 left(-std::sin(axis.heading_rad), std::cos(axis.heading_rad), 0.0);
  return MakeTransform(world_from_track,
                       axis.position_m + d_m * left + h_m * world_from_track.col(2));
}

}  // namespace railcast
