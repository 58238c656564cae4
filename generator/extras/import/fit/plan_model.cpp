#include "generator/extras/import/fit/plan_model.h"

#include <algorithm>
#include <cmath>

#include "core/rail/line/alignment_course.h"

namespace railcast {
namespace {

/// Shorter elements would be refused by an alignment.
constexpr double kShortestElement_m = 1e-3;
constexpr double kLengthSteps_per_m = 1e4;
constexpr double kRadiusSteps_per_m = 1e6;

constexpr double kCantSlope_mPerMmKmph = 0.01;  // 10 v mm of length for each mm of cant.
constexpr double kShareOfBalancingCant = 0.6;
constexpr double kHighestCant_mm = 150.0;
constexpr double kHighestDeficiency_mm = 130.0;
constexpr double kShortestUsualClothoid_m = 15.0;
constexpr double kShortestUsualClothoid_mPerKmph = 0.2;  // 0.7 s of running.

}  // namespace

double PlanModel::length_m() const {
  double length_m = 0.0;
  for (const Plateau& plateau : plateaus) length_m += plateau.length_m;
  return length_m;
}

double PlanModel::ConstantLength_m(std::size_t plateau) const {
  double length_m = plateaus[plateau].length_m;
  if (plateau > 0) length_m -= 0.5 * clothoids_m[plateau - 1];
  if (plateau < clothoids_m.size()) length_m -= 0.5 * clothoids_m[plateau];
  return length_m;
}

double PlanModel::ConstantBegin_m(std::size_t plateau) const {
  double s_m = plateau > 0 ? 0.5 * clothoids_m[plateau - 1] : 0.0;
  for (std::size_t i = 0; i < plateau; ++i) s_m += plateaus[i].length_m;
  return s_m;
}

PiecewiseLinear PlanModel::Curvature() const {
  std::vector<LinearPiece> pieces;
  double s_m = 0.0;
  for (std::size_t i = 0; i < plateaus.size(); ++i) {
    const double curvature_per_m = plateaus[i].curvature_per_m;
    const double constant_m = ConstantLength_m(i);
    if (constant_m > 0.0) {
      pieces.push_back({s_m, curvature_per_m, curvature_per_m});
      s_m += constant_m;
    }
    if (i < clothoids_m.size()) {
      pieces.push_back({s_m, curvature_per_m, plateaus[i + 1].curvature_per_m});
      s_m += clothoids_m[i];
    }
  }
  return {std::move(pieces), s_m};
}

std::vector<AlignmentElement> PlanModel::Elements() const {
  std::vector<AlignmentElement> elements;
  for (std::size_t i = 0; i < plateaus.size(); ++i) {
    const double curvature_per_m = plateaus[i].curvature_per_m;
    const double constant_m =
        std::max(RoundedTo(ConstantLength_m(i), kLengthSteps_per_m), kShortestElement_m);
    if (curvature_per_m == 0.0) {
      elements.push_back({ElementType::kStraight, constant_m, {}});
    } else {
      elements.push_back(
          {ElementType::kArc, constant_m, RoundedTo(1.0 / curvature_per_m, kRadiusSteps_per_m)});
    }
    if (i < clothoids_m.size()) {
      elements.push_back(
          {ElementType::kClothoid, RoundedTo(clothoids_m[i], kLengthSteps_per_m), {}});
    }
  }
  return elements;
}

PlanModel PlanOf(const PlanPoint& start, const std::vector<AlignmentElement>& elements) {
  PlanModel plan;
  plan.start = start;
  for (const AlignmentElement& element : elements) {
    if (element.type == ElementType::kClothoid) {
      plan.clothoids_m.push_back(element.length_m);
      continue;
    }
    plan.plateaus.push_back({element.radius_m ? 1.0 / *element.radius_m : 0.0, element.length_m});
  }
  for (std::size_t i = 0; i < plan.clothoids_m.size(); ++i) {
    plan.plateaus[i].length_m += 0.5 * plan.clothoids_m[i];
    plan.plateaus[i + 1].length_m += 0.5 * plan.clothoids_m[i];
  }
  return plan;
}

double RoundedTo(double value, double steps_per_unit) {
  return std::round(value * steps_per_unit) / steps_per_unit;
}

Foot FootOn(const PlanCourse& course,
            double length_m,
            const Eigen::Vector2d& point_m,
            double guess_m) {
  constexpr int kMostSteps = 8;
  // The offset changes with the square of what is left: 1e-6 m of it at a radius of 50 m.
  constexpr double kTolerance_m = 0.01;
  Foot foot{std::clamp(guess_m, 0.0, length_m), 0.0, 0.0};
  for (int step = 0; step < kMostSteps; ++step) {
    const PlanPoint at = course.At(foot.s_m);
    const Eigen::Vector2d ahead(std::cos(at.heading_rad), std::sin(at.heading_rad));
    const Eigen::Vector2d to_point_m = point_m - Eigen::Vector2d(at.x_m, at.y_m);
    foot.beyond_m = to_point_m.dot(ahead);
    foot.offset_m = ahead.x() * to_point_m.y() - ahead.y() * to_point_m.x();
    const double stretch = std::max(0.3, 1.0 - at.curvature_per_m * foot.offset_m);
    const double next_m = std::clamp(foot.s_m + foot.beyond_m / stretch, 0.0, length_m);
    if (std::abs(next_m - foot.s_m) < kTolerance_m) break;
    foot.s_m = next_m;
  }
  return foot;
}

double UsualClothoid_m(double speed_kmph, double from_per_m, double to_per_m) {
  const double cant_mm = std::min(kShareOfBalancingCant * kBalancingCant * speed_kmph * speed_kmph *
                                      std::abs(to_per_m - from_per_m),
                                  kHighestCant_mm);
  return std::max({kShortestUsualClothoid_m, kShortestUsualClothoid_mPerKmph * speed_kmph,
                   kCantSlope_mPerMmKmph * speed_kmph * cant_mm});
}

double SharpestCurvature_per_m(double speed_kmph) {
  return (kHighestCant_mm + kHighestDeficiency_mm) / (kBalancingCant * speed_kmph * speed_kmph);
}

}  // namespace railcast
