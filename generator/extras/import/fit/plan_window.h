#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "generator/extras/import/fit/plan_model.h"

namespace railcast {

/// Where a point's foot lies on a course.
struct Foot {
  double s_m{};       ///< Chainage, within the course.
  double offset_m{};  ///< Of the point, left positive.
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

/// A part of a plan that is fitted to points by itself. Its beginning and its end stay where they
/// are, except at the ends of the line.
struct PlanWindow {
  PlanModel plan;                         ///< The part: its chainages begin at 0.
  std::vector<bool> has_fixed_curvature;  ///< For each plateau.
  std::vector<Eigen::Vector2d> points_m;
  std::vector<double> feet_m;  ///< Where the feet of the points are expected.
  bool begins_line = false;    ///< Position and heading of its beginning are free.
  bool ends_line = false;
  PlanPoint end;  ///< Where it must end unless it ends the line.
  double sigma_m{};
  double speed_kmph{};
  std::size_t num_feet{};  ///< Sought by Fit, which is what it costs.

  /// Fits the part to its points by least squares (Levenberg-Marquardt, as in MINPACK).
  ///
  /// Residuals are the points' distances in units of sigma, with a pseudo-Huber loss that becomes
  /// linear at 2 sigma; the logarithm of each clothoid's length against its usual one, in units of
  /// 0.5; and penalties for curvatures sharper than the speed allows, for constant parts shorter
  /// than 20 m, and for clothoids of fast lines, above 160 km/h, shorter than half the usual one.
  /// Real lines have the former two where there is no room.
  /// @returns The sum of squares that is left.
  double Fit();
};

}  // namespace railcast
