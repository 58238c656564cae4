#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "generator/extras/import/fit/plan_model.h"

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
  std::vector<double> chainages_m;  ///< Chainages of the points' feet on the line, in their order.
  /// The points' distances from the line, left positive; before and behind its ends, from these.
  std::vector<double> offsets_m;
};

/// The feet of points on a plan and their offsets, which FitLine gives for its own plan.
/// @param guesses_m Chainage near each point's foot.
[[nodiscard]] LineFit MeasureFit(const PlanModel& plan,
                                 std::span<const Eigen::Vector2d> points_m,
                                 std::span<const double> guesses_m);

/// Is told how much of a work is done, as a share. Empty: nobody is.
using TellShare = std::function<void(double share)>;

/// Fits straights, arcs and clothoids to the points of a line, as few as explain them.
///
/// The points are divided into circular arcs as long as possible within 2 sigma, which are joined
/// by clothoids and fitted one after another. Then single changes are made, always the one that
/// lowers the sum of squares (PlanWindow::Fit) plus a price for each parameter most, until none
/// does by 0.5 or more: a plateau is removed, joined with the next one, straightened or divided. A
/// change fits the few elements about it anew and leaves the rest of the line where it is, so that
/// what it costs does not depend on the line's length. An arc of n points is found with some n^2 /
/// 2 distances. There are at most 10 changes for each of the first arcs, and 100 more. At last
/// the radius of an arc flatter than 20 km has four times the price: points that are some
/// decimetres off together, as mapped ones are, would make one. What is left of such arcs becomes
/// straight wherever this leaves no point more than 2 sigma off, or more than it was.
///
/// @param points_m At least two, in order along the line, no two neighbours equal.
///
///     const LineFit fit = FitLine(points_m, {.sigma_m = 0.3});
///     AlignmentSpec alignment{.course = AlignmentElementsSpec{fit.plan.Elements()}};
[[nodiscard]] LineFit FitLine(std::span<const Eigen::Vector2d> points_m,
                              const LinePrior& prior,
                              const TellShare& tell = {});

}  // namespace railcast
