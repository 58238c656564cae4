#include "generator/extras/import/fit/plan_window.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <unsupported/Eigen/NumericalDiff>
#include <vector>

namespace railcast {
namespace {

/// A window of all kinds of elements whose points lie some decimetres beside it, before and behind
/// its ends, and for which each cost of lengths and curvatures is at work: the sharp arc, the short
/// plateau, the short clothoids of a fast line.
PlanWindow WindowOfAllElements() {
  PlanWindow window;
  window.plan.start = {.x_m = 4000.0, .y_m = -7000.0, .heading_rad = 2.5};
  window.plan.plateaus = {{0.0, 400.0},         {1.0 / 300.0, 600.0}, {-1.0 / 1500.0, 61.0},
                          {1.0 / 400e3, 900.0}, {0.0, 300.0},         {-1.0 / 2500.0, 350.0}};
  window.plan.clothoids_m = {120.0, 60.0, 40.0, 20.0, 90.0};
  window.has_fixed_curvature = {true, false, false, false, true, false};
  window.sigma_m = 0.3;
  window.speed_kmph = 170.0;
  const PlanCourse course = window.plan.Course();
  const double length_m = window.plan.length_m();
  for (double s_m = -15.0; s_m < length_m + 40.0; s_m += 35.0) {
    const double foot_m = std::clamp(s_m, 0.0, length_m);
    const PlanPoint at = course.At(foot_m);
    const Eigen::Vector2d ahead(std::cos(at.heading_rad), std::sin(at.heading_rad));
    const double offset_m = 0.8 * std::sin(s_m);
    window.points_m.emplace_back(at.x_m + (s_m - foot_m) * ahead.x() - offset_m * ahead.y(),
                                 at.y_m + (s_m - foot_m) * ahead.y() + offset_m * ahead.x());
    window.feet_m.push_back(foot_m);
  }
  window.end = course.At(length_m);
  window.end.x_m += 0.01;
  return window;
}

/// How far derivatives in closed form are from quotients of central differences.
void ExpectTheDerivativesOfDifferences(const PlanWindow& window) {
  const WindowResiduals residuals(window);
  const Eigen::VectorXd parameters = residuals.Parameters();
  Eigen::VectorXd values;
  residuals(parameters, values);
  Eigen::MatrixXd closed;
  residuals.df(parameters, closed);

  // Steps of 3e-7 of a parameter move no foot by the 0.01 m from which on feet are sought anew, so
  // that what a foot is off is the same on both sides.
  constexpr double kStep = 1e-13;
  Eigen::NumericalDiff<WindowResiduals, Eigen::Central> differences(residuals, kStep);
  Eigen::MatrixXd quotients(residuals.values(), residuals.inputs());
  differences.df(parameters, quotients);

  // Only the foot of the last point, which lies beyond the end, follows an end that comes nearer
  // and not one that goes away.
  const auto last = static_cast<Eigen::Index>(window.points_m.size()) - 1;
  const auto tolerance_of = [&](Eigen::Index value) {
    const bool is_of_last = value == last || value == residuals.values() - 4;
    return is_of_last ? 0.01 : 1e-5;
  };
  for (Eigen::Index parameter = 0; parameter < residuals.inputs(); ++parameter) {
    for (Eigen::Index value = 0; value < residuals.values(); ++value) {
      EXPECT_NEAR(closed(value, parameter), quotients(value, parameter),
                  tolerance_of(value) * std::max(1.0, quotients.row(value).cwiseAbs().maxCoeff()))
          << "residual " << value << " by parameter " << parameter;
    }
  }
}

TEST(WindowResiduals, HaveTheDerivativesOfTheirDifferences) {
  for (const bool begins_line : {false, true}) {
    for (const bool ends_line : {false, true}) {
      SCOPED_TRACE(testing::Message() << begins_line << ' ' << ends_line);
      PlanWindow window = WindowOfAllElements();
      window.begins_line = begins_line;
      window.ends_line = ends_line;
      ExpectTheDerivativesOfDifferences(window);
    }
  }
}

}  // namespace
}  // namespace railcast
