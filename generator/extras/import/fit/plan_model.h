#pragma once

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

}  // namespace railcast
