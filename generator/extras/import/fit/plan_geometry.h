#pragma once

#include <Eigen/Core>

#include "generator/extras/import/fit/plan_model.h"

namespace railcast {

/// Where a point's foot lies on a course.
struct Foot {
  double s_m{};       ///< Chainage, within the course.
  double offset_m{};  ///< Offset of the point, left positive.
  double beyond_m{};  ///< How far the point lies behind (negative: before) the end of the course.
};

/// The foot of a point near a guess.
[[nodiscard]] Foot FootOn(const PlanCourse& course,
                          double length_m,
                          const Eigen::Vector2d& point_m,
                          double guess_m);

[[nodiscard]] inline double CrossProduct(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Curvature of the circle through three points, left positive.
[[nodiscard]] inline double CircleCurvature_per_m(const Eigen::Vector2d& a,
                                                  const Eigen::Vector2d& b,
                                                  const Eigen::Vector2d& c) {
  const double product = (b - a).norm() * (c - a).norm() * (c - b).norm();
  return product > 0.0 ? 2.0 * CrossProduct(b - a, c - a) / product : 0.0;
}

/// The clothoid that a line for this speed usually has between two curvatures: as long as the ramp
/// of the cant at a slope of 1 : 10 v (EN 13803-1), of which 60 % of the balancing cant is built,
/// and at least 15 m and 0.2 m for each km/h.
[[nodiscard]] double UsualClothoid_m(double speed_kmph, double from_per_m, double to_per_m);

/// The sharpest curvature at a speed: a cant of 150 mm and a deficiency of 130 mm (EN 13803-1).
[[nodiscard]] double SharpestCurvature_per_m(double speed_kmph);

}  // namespace railcast
