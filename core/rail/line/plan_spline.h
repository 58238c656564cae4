#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/base/error.h"
#include "core/rail/line/plan_course.h"

namespace railcast {

/// The natural cubic spline through plan points, parametrised by chord length and re-parametrised
/// by its own arc length. It goes through every point; tangent and curvature are continuous, the
/// curvature is 0 at both ends.
class PlanSpline {
 public:
  /// Faults go to `errors` with pointers below "/course/points_m": too few or coincident points,
  /// and a cusp (a radius below kSmallestRadius_m). If there are any, the spline must not be used.
  PlanSpline(std::vector<Eigen::Vector2d> points_m, ErrorList& errors);

  [[nodiscard]] double length_m() const { return length_m_; }
  [[nodiscard]] double tightest_radius_m() const { return tightest_radius_m_; }

  /// @pre 0 <= s_m <= length_m().
  [[nodiscard]] PlanPoint At(double s_m) const;

 private:
  /// Where the spline is at a parameter, with its first two derivatives.
  struct Jet {
    Eigen::Vector2d position_m, tangent, bend_per_m;
    [[nodiscard]] double curvature_per_m() const;
  };
  /// Arc length is tabulated at nodes.
  struct Node {
    double s_m{};
    std::size_t segment{};
    double inside_m{};     ///< Chord-length parameter from the segment's begin.
    double heading_rad{};  ///< Grows on through full turns.
  };

  void SolveBends();
  void CheckRadii(ErrorList& errors);
  void Tabulate();
  [[nodiscard]] double ChordLength(std::size_t segment) const;
  [[nodiscard]] Jet At(std::size_t segment, double inside_m) const;
  [[nodiscard]] double ArcLength(std::size_t segment, double from_m, double to_m) const;

  std::vector<Eigen::Vector2d> points_m_;
  std::vector<Eigen::Vector2d> bends_per_m_;  ///< Second derivative at each point.
  std::vector<Node> nodes_;
  double length_m_{};
  double tightest_radius_m_{};
};

}  // namespace railcast
