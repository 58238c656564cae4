#include "generator/extras/import/fit/plan_geometry.h"

#include <algorithm>
#include <cmath>

#include "core/rail/line/alignment_course.h"

namespace railcast {
namespace {

constexpr double kCantSlope_mPerMmKmph = 0.01;  // 10 v mm of length for each mm of cant.
constexpr double kShareOfBalancingCant = 0.6;
constexpr double kHighestCant_mm = 150.0;
constexpr double kHighestDeficiency_mm = 130.0;
constexpr double kShortestUsualClothoid_m = 15.0;
constexpr double kShortestUsualClothoid_mPerKmph = 0.2;  // 0.7 s of running.

}  // namespace

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
