#include "core/rail/line/biarc.h"

#include <Eigen/Core>
#include <algorithm>
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
