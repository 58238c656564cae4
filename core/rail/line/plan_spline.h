#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/base/error.h"
#include "core/rail/line/plan_course.h"

namespace railcast {

/// The natural cubic spline through plan points, parametrised by chord length and then
/// reparametrised by arc length. It passes through every point; tangent and curvature are
/// continuous, and the curvature is 0 at both ends.
class PlanSpline {
 public:
  /// Faults are appended to `errors` with pointers below "/course/points_m": too few or coincident
  /// points, and cusps (radii below kSmallestRadius_m). If there are any, the spline must not be
  /// used.
  PlanSpline(std::vector<Eigen::Vector2d> points_m, ErrorList& errors);

  [[nodiscard]] double length_m() const { return length_m_; }
  [[nodiscard]] double tightest_radius_m() const { return tightest_radius_m_; }

  /// @pre 0 <= s_m <= length_m().
  [[nodiscard]] PlanPoint At(double s_m) const;

 private:
  /// Position of the spline at a parameter, and its first two derivatives.
  struct Jet {
    Eigen::Vector2d position_m, tangent, bend_per_m;
    [[nodiscard]] double curvature_per_m() const;
  };
  /// Tabulated arc length.
  struct Node {
    double s_m{};
    std::size_t segment{};
    double inside_m{};     ///< Chord-length parameter relative to the start of the segment.
    double heading_rad{};  ///< Continuous, so it may exceed a full turn.
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
