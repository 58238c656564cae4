#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/base/error.h"
#include "core/rail/line/piecewise_linear.h"

namespace railcast {

/// The axis in plan at one chainage.
struct PlanPoint {
  double x_m{};
  double y_m{};
  double heading_rad{};  ///< Counterclockwise from east; continuous, so it may exceed a full turn.
  double curvature_per_m{};
};

/// The plan curve of a piecewise linear curvature: straights, clothoids and arcs.
///
/// The heading is the exact integral of the curvature. The position is the integral of (cos, sin)
/// of the heading by 5-point Gauss-Legendre quadrature, starting at the last preceding node. Nodes
/// lie at every change of slope and at most kNodeSpacing_m apart, with which the error of one step
/// is below 1e-11 m at a radius of kSmallestRadius_m, and below rounding for radii of 50 m or more.
class PlanCourse {
 public:
  static constexpr double kNodeSpacing_m = 10.0;

  /// @param start Position and heading at chainage 0; its curvature is not used.
  /// @param node_spacing_m Fewer nodes take less time to make: at 200 m, the error of a step at a
  ///   radius of 100 m is below 1e-6 m.
  PlanCourse(const PiecewiseLinear& curvature,
             const PlanPoint& start,
             double node_spacing_m = kNodeSpacing_m);

  /// @pre 0 <= s_m <= the end of the curvature.
  [[nodiscard]] PlanPoint At(double s_m) const;

 private:
  struct Node {
    double s_m{};
    PlanPoint point;
    double slope_per_m2{};  ///< Slope of the curvature up to the next node.
  };
  [[nodiscard]] static PlanPoint Advance(const Node& node, double length_m);

  std::vector<Node> nodes_;
};

/// Two arcs, one behind the other, that lead from one place and direction to another. Either may be
/// straight.
struct Biarc {
  double first_m{};  ///< Length.
  double first_per_m{};
  double second_m{};
  double second_per_m{};

  [[nodiscard]] double length_m() const { return first_m + second_m; }
  [[nodiscard]] double sharpest_per_m() const {
    return std::max(std::abs(first_per_m), std::abs(second_per_m));
  }
};

/// The two arcs with tangents of equal length. Curvatures of the points are not used.
/// @return Nothing if the arcs would have to turn by more than 90 degrees each, as they must if the
///   second place is not ahead of the first.
[[nodiscard]] std::optional<Biarc> BiarcBetween(const PlanPoint& from, const PlanPoint& to);

/// Nodes on [-1, 1] and weights of 5-point Gauss-Legendre quadrature, exact for polynomials of
/// degree 9 (Abramowitz and Stegun 1964, table 25.4).
struct GaussLegendreNode {
  double position{};
  double weight{};
};
inline constexpr std::array<GaussLegendreNode, 5> kGaussLegendre = {{
    {-0.90617984593866399280, 0.23692688505618908751},
    {-0.53846931010568309104, 0.47862867049936646804},
    {0.0, 0.56888888888888888889},
    {0.53846931010568309104, 0.47862867049936646804},
    {0.90617984593866399280, 0.23692688505618908751},
}};

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
