#include "core/rail/line/plan_course.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace railcast {
namespace {

Eigen::Vector2d DirectionAt(const PlanPoint& point) {
  return {std::cos(point.heading_rad), std::sin(point.heading_rad)};
}

/// The angle by which a direction must turn to become another one, left positive.
double TurnBetween_rad(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  return std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
}

}  // namespace

PlanCourse::PlanCourse(const PiecewiseLinear& curvature,
                       const PlanPoint& start,
                       double node_spacing_m) {
  Node node{curvature.pieces().front().begin_s_m, start, 0.0};
  for (std::size_t i = 0; i < curvature.pieces().size(); ++i) {
    const LinearPiece& piece = curvature.pieces()[i];
    const double length_m = curvature.EndOf(i) - piece.begin_s_m;
    const double num_steps = std::ceil(length_m / node_spacing_m);
    node.slope_per_m2 = curvature.SlopeOf(i);
    node.point.curvature_per_m = piece.begin_value;
    for (double step = 0.0; step < num_steps; ++step) {
      nodes_.push_back(node);
      const double next_s_m = piece.begin_s_m + length_m * ((step + 1.0) / num_steps);
      node.point = Advance(node, next_s_m - node.s_m);
      node.s_m = next_s_m;
    }
  }
}

PlanPoint PlanCourse::Advance(const Node& node, double length_m) {
  const auto heading_rad = [&](double inside_m) {
    return node.point.heading_rad +
           (node.point.curvature_per_m + 0.5 * node.slope_per_m2 * inside_m) * inside_m;
  };
  const double half_m = 0.5 * length_m;
  PlanPoint point = node.point;
  for (const auto& [position, weight] : kGaussLegendre) {
    const double angle_rad = heading_rad(half_m * (1.0 + position));
    point.x_m += half_m * weight * std::cos(angle_rad);
    point.y_m += half_m * weight * std::sin(angle_rad);
  }
  point.heading_rad = heading_rad(length_m);
  point.curvature_per_m += node.slope_per_m2 * length_m;
  return point;
}

PlanPoint PlanCourse::At(double s_m) const {
  const auto after = std::upper_bound(nodes_.begin() + 1, nodes_.end(), s_m,
                                      [](double s, const Node& node) { return s < node.s_m; });
  const Node& node = *(after - 1);
  return Advance(node, s_m - node.s_m);
}

std::optional<Biarc> BiarcBetween(const PlanPoint& from, const PlanPoint& to) {
  const Eigen::Vector2d way_m(to.x_m - from.x_m, to.y_m - from.y_m);
  const Eigen::Vector2d leave = DirectionAt(from);
  const Eigen::Vector2d arrive = DirectionAt(to);
  // With tangents of length t, both arcs meet half way between from + t leave and to - t arrive,
  // which are 2 t apart: |way - t (leave + arrive)| = 2 t.
  const double along_m = way_m.dot(leave + arrive);
  const double root_m =
      std::sqrt(along_m * along_m + 2.0 * (1.0 - leave.dot(arrive)) * way_m.squaredNorm());
  if (!(along_m + root_m > 0.0)) return std::nullopt;
  const double tangent_m = way_m.squaredNorm() / (along_m + root_m);
  const Eigen::Vector2d first_m = 0.5 * (way_m + tangent_m * (leave - arrive));
  const Eigen::Vector2d second_m = way_m - first_m;
  // An arc turns by twice the angle between its chord and its tangent.
  const double first_rad = 2.0 * TurnBetween_rad(leave, first_m);
  const double second_rad = 2.0 * TurnBetween_rad(second_m, arrive);
  constexpr double kMostTurn_rad = 0.5 * std::numbers::pi;
  if (!(std::max(std::abs(first_rad), std::abs(second_rad)) <= kMostTurn_rad)) return std::nullopt;
  const auto arc_m = [](double chord_m, double turn_rad) {
    return turn_rad == 0.0 ? chord_m : 0.5 * chord_m * turn_rad / std::sin(0.5 * turn_rad);
  };
  const double one_m = arc_m(first_m.norm(), first_rad);
  const double other_m = arc_m(second_m.norm(), second_rad);
  if (!(one_m > 0.0 && other_m > 0.0)) return std::nullopt;
  return Biarc{one_m, first_rad / one_m, other_m, second_rad / other_m};
}

}  // namespace railcast
