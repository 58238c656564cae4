#include "core/rail/line/plan_course.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "core/base/text.h"
#include "core/rail/line/alignment_course.h"

namespace railcast {
namespace {

Eigen::Vector2d DirectionAt(const PlanPoint& point) {
  return {std::cos(point.heading_rad), std::sin(point.heading_rad)};
}

/// The angle by which a direction must turn to become another one, left positive.
double TurnBetween_rad(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  return std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
}

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
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

PlanSpline::PlanSpline(std::vector<Eigen::Vector2d> points_m, ErrorList& errors)
    : points_m_(std::move(points_m)) {
  const std::size_t num_faults = errors.size();
  if (points_m_.size() < 2) {
    errors.Add({"/course/points_m", "must have at least 2 points", NumberText(points_m_.size())});
  }
  for (std::size_t i = 1; i < points_m_.size(); ++i) {
    if (!(ChordLength(i - 1) > 1e-3)) {
      errors.Add({"/course/points_m/" + std::to_string(i),
                  "must be at least 0.001 m from the point before",
                  NumberText(ChordLength(i - 1))});
    }
  }
  if (errors.size() > num_faults) return;
  SolveBends();
  CheckRadii(errors);
  if (errors.size() > num_faults) return;
  Tabulate();
}

double PlanSpline::ChordLength(std::size_t segment) const {
  return (points_m_[segment + 1] - points_m_[segment]).norm();
}

// Solves the tridiagonal system of the natural cubic spline by elimination (de Boor 1978, A
// Practical Guide to Splines, chapter IV).
void PlanSpline::SolveBends() {
  const std::size_t count = points_m_.size();
  bends_per_m_.assign(count, Eigen::Vector2d::Zero());
  std::vector<double> upper(count, 0.0);
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const double before_m = ChordLength(i - 1);
    const double after_m = ChordLength(i);
    const Eigen::Vector2d slope_change =
        (points_m_[i + 1] - points_m_[i]) / after_m - (points_m_[i] - points_m_[i - 1]) / before_m;
    const double pivot = 2.0 * (before_m + after_m) - before_m * upper[i - 1];
    upper[i] = after_m / pivot;
    bends_per_m_[i] = (6.0 * slope_change - before_m * bends_per_m_[i - 1]) / pivot;
  }
  for (std::size_t i = count - 1; i-- > 1;) bends_per_m_[i] -= upper[i] * bends_per_m_[i + 1];
}

PlanSpline::Jet PlanSpline::At(std::size_t segment, double inside_m) const {
  const double length_m = ChordLength(segment);
  const double b = inside_m / length_m;
  const double a = 1.0 - b;
  const Eigen::Vector2d& bend_0 = bends_per_m_[segment];
  const Eigen::Vector2d& bend_1 = bends_per_m_[segment + 1];
  const Eigen::Vector2d& point_0 = points_m_[segment];
  const Eigen::Vector2d& point_1 = points_m_[segment + 1];
  const double sixth = length_m * length_m / 6.0;
  return {a * point_0 + b * point_1 + sixth * ((a * a * a - a) * bend_0 + (b * b * b - b) * bend_1),
          (point_1 - point_0) / length_m +
              length_m / 6.0 * ((1.0 - 3.0 * a * a) * bend_0 + (3.0 * b * b - 1.0) * bend_1),
          a * bend_0 + b * bend_1};
}

double PlanSpline::Jet::curvature_per_m() const {
  const double speed = tangent.norm();
  return Cross(tangent, bend_per_m) / (speed * speed * speed);
}

// The radius has its minimum near a minimum of the parametric speed, where the tangent and its
// derivative are perpendicular; at a cusp the speed is 0. These places are therefore checked in
// addition to regular samples.
void PlanSpline::CheckRadii(ErrorList& errors) {
  constexpr int kSteps = 64;
  tightest_radius_m_ = std::numeric_limits<double>::infinity();
  const auto radius_m = [](const Jet& jet) {
    // A spline that reverses on a straight line has no curvature there but is a cusp nevertheless.
    constexpr double kStandstill = 1e-6;
    return jet.tangent.norm() < kStandstill ? 0.0 : 1.0 / std::abs(jet.curvature_per_m());
  };
  const auto slowing = [](const Jet& jet) { return jet.tangent.dot(jet.bend_per_m); };

  for (std::size_t segment = 0; segment + 1 < points_m_.size(); ++segment) {
    const double step_m = ChordLength(segment) / kSteps;
    double least_m = radius_m(At(segment, 0.0));
    for (int i = 0; i < kSteps; ++i) {
      double from_m = i * step_m;
      double to_m = (i + 1) * step_m;
      least_m = std::min(least_m, radius_m(At(segment, to_m)));
      if (slowing(At(segment, from_m)) >= 0.0 || slowing(At(segment, to_m)) <= 0.0) continue;
      for (int halving = 0; halving < 50; ++halving) {
        const double middle_m = 0.5 * (from_m + to_m);
        (slowing(At(segment, middle_m)) < 0.0 ? from_m : to_m) = middle_m;
      }
      least_m = std::min(least_m, radius_m(At(segment, from_m)));
    }
    if (least_m < kSmallestRadius_m) {
      errors.Add({"/course/points_m/" + std::to_string(segment),
                  "the spline must not have a cusp between this point and the next, its radius be "
                  "at least " +
                      NumberText(kSmallestRadius_m) + " m",
                  NumberText(least_m)});
    }
    tightest_radius_m_ = std::min(tightest_radius_m_, least_m);
  }
}

double PlanSpline::ArcLength(std::size_t segment, double from_m, double to_m) const {
  const double half_m = 0.5 * (to_m - from_m);
  double length_m = 0.0;
  for (const auto& [position, weight] : kGaussLegendre) {
    length_m += half_m * weight * At(segment, from_m + half_m * (1.0 + position)).tangent.norm();
  }
  return length_m;
}

void PlanSpline::Tabulate() {
  const Eigen::Vector2d first = At(0, 0.0).tangent;
  double heading_rad = std::atan2(first.y(), first.x());
  for (std::size_t segment = 0; segment + 1 < points_m_.size(); ++segment) {
    const double chord_m = ChordLength(segment);
    const double num_steps = std::ceil(chord_m / PlanCourse::kNodeSpacing_m);
    double inside_m = 0.0;
    for (double step = 1.0; step <= num_steps; ++step) {
      nodes_.push_back({length_m_, segment, inside_m, heading_rad});
      const double next_m = chord_m * (step / num_steps);
      const Eigen::Vector2d before = At(segment, inside_m).tangent;
      const Eigen::Vector2d after = At(segment, next_m).tangent;
      heading_rad += std::atan2(Cross(before, after), before.dot(after));
      length_m_ += ArcLength(segment, inside_m, next_m);
      inside_m = next_m;
    }
  }
}

PlanPoint PlanSpline::At(double s_m) const {
  const auto after = std::upper_bound(nodes_.begin() + 1, nodes_.end(), s_m,
                                      [](double s, const Node& node) { return s < node.s_m; });
  const Node& node = *(after - 1);
  const Eigen::Vector2d tangent_at_node = At(node.segment, node.inside_m).tangent;
  // Newton's method on arc length. Chord and arc length are nearly equal, so it converges at once.
  double inside_m = node.inside_m + (s_m - node.s_m) / tangent_at_node.norm();
  Jet jet = At(node.segment, inside_m);
  for (int iteration = 0; iteration < 8; ++iteration) {
    const double error_m = ArcLength(node.segment, node.inside_m, inside_m) - (s_m - node.s_m);
    inside_m -= error_m / jet.tangent.norm();
    jet = At(node.segment, inside_m);
    if (std::abs(error_m) < 1e-10) break;
  }
  const double turn_rad =
      std::atan2(Cross(tangent_at_node, jet.tangent), tangent_at_node.dot(jet.tangent));
  return {jet.position_m.x(), jet.position_m.y(), node.heading_rad + turn_rad,
          jet.curvature_per_m()};
}

}  // namespace railcast
