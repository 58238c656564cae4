#include "core/rail/line/plan_course.h"

#include <algorithm>
#include <cmath>

#include "core/rail/line/gauss_legendre.h"

namespace railcast {

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

}  // namespace railcast
