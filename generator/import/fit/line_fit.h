#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "generator/import/fit/plan_model.h"

namespace railcast {

/// What is known about a line apart from its points.
struct LinePrior {
  double sigma_m = 0.3;  ///< Standard deviation of the points across the line.
  /// Speed for which the line is built, by the distance along its points. It decides how long
  /// clothoids usually are and how sharp arcs may be.
  std::function<double(double along_m)> speed_kmph = [](double) { return 80.0; };
};

struct LineFit {
  PlanModel plan;
  std::vector<double> chainages_m;  ///< Of the points' feet on the line, in their order.
  std::vector<double> offsets_m;    ///< Of the points from the line, left positive.
};

/// Fits straights, arcs and clothoids to the points of a line, as few as explain them.
///
/// The points are divided into circular arcs as long as possible within 2 sigma, which are joined
/// by clothoids and fitted one after another. Then single changes are made, always the one that
/// lowers the sum of squares (PlanWindow::Fit) plus a price for each parameter most, until none
/// does: a plateau is removed, joined with the next one, straightened or divided. A change fits the
/// few elements about it anew and leaves the rest of the line where it is, so that the time grows
/// with the line's length only.
///
/// @param points_m At least two, in order along the line, no two neighbours equal.
///
///     const LineFit fit = FitLine(points_m, {.sigma_m = 0.3});
///     AlignmentSpec alignment{.course = AlignmentElementsSpec{fit.plan.Elements()}};
[[nodiscard]] LineFit FitLine(std::span<const Eigen::Vector2d> points_m, const LinePrior& prior);

}  // namespace railcast
