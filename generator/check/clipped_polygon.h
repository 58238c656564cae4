#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace railcast {

/// The part of a polygon on one side of a line parallel to an axis (Sutherland, Hodgman 1974).
/// @param axis 0: what has x up to the limit is left; 1: y.
/// @param sign -1: what has at least the limit is left instead.
[[nodiscard]] inline std::vector<Eigen::Vector2d> Clipped(
    const std::vector<Eigen::Vector2d>& polygon, int axis, double limit, double sign) {
  std::vector<Eigen::Vector2d> inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
    const double from_a = sign * (limit - a[axis]);
    const double from_b = sign * (limit - b[axis]);
    if (from_a >= 0.0) inside.push_back(a);
    if ((from_a >= 0.0) != (from_b >= 0.0)) {
      inside.emplace_back(a + from_a / (from_a - from_b) * (b - a));
    }
  }
  return inside;
}

}  // namespace railcast
