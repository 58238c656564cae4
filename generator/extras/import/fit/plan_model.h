#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/rail/line/piecewise_linear.h"
#include "core/rail/line/plan_course.h"
#include "railcast/alignment.h"

namespace railcast {

/// A stretch of constant curvature: a straight or an arc.
struct Plateau {
  double curvature_per_m{};  ///< Left positive; exactly 0: a straight.
  /// Length from the middle of the clothoid before it to the middle of the one behind it; from or
  /// to the end of the line where there is none.
  double length_m{};
};

/// The plan of a line as railways are built: straights and arcs, joined by clothoids.
///
/// Lengths are measured between the middles of clothoids, so that a clothoid may become longer or
/// shorter while the tangents of both its neighbours stay where they are in the first order.
struct PlanModel {
  PlanPoint start;                  ///< Its curvature is not used.
  std::vector<Plateau> plateaus;    ///< At least one.
  std::vector<double> clothoids_m;  ///< Length of the clothoid between plateaus i and i + 1; > 0.

  [[nodiscard]] double length_m() const;
  /// Length of the constant part of a plateau; negative if its clothoids overlap.
  [[nodiscard]] double ConstantLength_m(std::size_t plateau) const;
  /// Chainage at which the constant part of a plateau begins.
  [[nodiscard]] double ConstantBegin_m(std::size_t plateau) const;

  /// @pre No constant part is shorter than 0.
  [[nodiscard]] PiecewiseLinear Curvature() const;
  [[nodiscard]] PlanCourse Course() const {
    constexpr double kNodeSpacing_m = 200.0;
    return {Curvature(), start, kNodeSpacing_m};
  }
  /// The same as elements of an alignment, rounded for files: lengths to 0.1 mm, radii to 1e-6 m,
  /// since an error of the direction moves all that follows: 1 mm of a radius of 500 m over 700 m
  /// of arc is 0.14 m at the end of 50 km. Constant parts shorter than 1 mm become 1 mm long.
  [[nodiscard]] std::vector<AlignmentElement> Elements() const;
};

/// The plan that such elements make.
/// @pre Straights and arcs take turns with clothoids; a clothoid is neither first nor last.
[[nodiscard]] PlanModel PlanOf(const PlanPoint& start,
                               const std::vector<AlignmentElement>& elements);

/// The nearest multiple of 1 / `steps_per_unit`.
[[nodiscard]] double RoundedTo(double value, double steps_per_unit);

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
