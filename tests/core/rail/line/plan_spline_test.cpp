#include "core/rail/line/plan_course.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace railcast {
namespace {

std::vector<Eigen::Vector2d> WindingPoints() {
  return {{0, 0}, {180, 20}, {390, -30}, {520, 60}, {530, 240}, {410, 330}, {200, 300}};
}

PlanSpline Spline(const std::vector<Eigen::Vector2d>& points_m) {
  ErrorList errors;
  PlanSpline spline(points_m, errors);
  EXPECT_THAT(errors.lines(), testing::IsEmpty());
  return spline;
}

std::vector<std::string> SplineFaults(const std::vector<Eigen::Vector2d>& points_m) {
  ErrorList errors;
  const PlanSpline spline(points_m, errors);
  return errors.lines();
}

TEST(PlanSpline, ThroughTwoPointsIsTheLineBetweenThem) {
  const PlanSpline spline = Spline({{1, 2}, {31, 42}});
  EXPECT_NEAR(spline.length_m(), 50.0, 1e-12);
  const PlanPoint point = spline.At(20.0);
  EXPECT_NEAR(point.x_m, 13.0, 1e-12);
  EXPECT_NEAR(point.y_m, 18.0, 1e-12);
  EXPECT_NEAR(point.heading_rad, std::atan2(4.0, 3.0), 1e-12);
  EXPECT_EQ(spline.tightest_radius_m(), std::numeric_limits<double>::infinity());
}

TEST(PlanSpline, GoesThroughEveryPoint) {
  const PlanSpline spline = Spline(WindingPoints());
  for (const Eigen::Vector2d& point_m : WindingPoints()) {
    double nearest_m = 1e9;
    for (double s_m = 0.0; s_m <= spline.length_m(); s_m += 0.01) {
      const PlanPoint point = spline.At(s_m);
      nearest_m = std::min(nearest_m, std::hypot(point.x_m - point_m.x(), point.y_m - point_m.y()));
    }
    EXPECT_LE(nearest_m, 0.01);  // Step of the search.
  }
}

TEST(PlanSpline, IsParametrisedByItsArcLength) {
  const PlanSpline spline = Spline(WindingPoints());
  const double step_m = 0.01;
  double sum_m = 0.0;
  PlanPoint before = spline.At(0.0);
  for (double s_m = step_m; s_m <= spline.length_m(); s_m += step_m) {
    const PlanPoint point = spline.At(s_m);
    sum_m += std::hypot(point.x_m - before.x_m, point.y_m - before.y_m);
    // A chord is shorter than its arc by (curvature step)^2 / 24, a relative 1e-8 here.
    ASSERT_NEAR(sum_m, s_m, 1e-8 * s_m + 1e-9);
    before = point;
  }
}

TEST(PlanSpline, TurnsByTheIntegralOfItsCurvature) {
  const PlanSpline spline = Spline(WindingPoints());
  const double step_m = 0.01;
  double heading_rad = spline.At(0.0).heading_rad;
  for (double s_m = 0.0; s_m + step_m <= spline.length_m(); s_m += step_m) {
    heading_rad += spline.At(s_m + 0.5 * step_m).curvature_per_m * step_m;
    // Midpoint rule: second derivative of about 1e-5 /m^3 x step^2 / 24 over 1.5 km.
    ASSERT_NEAR(spline.At(s_m + step_m).heading_rad, heading_rad, 1e-6);
  }
}

TEST(PlanSpline, HasContinuousCurvatureThatEndsStraight) {
  const PlanSpline spline = Spline(WindingPoints());
  EXPECT_NEAR(spline.At(0.0).curvature_per_m, 0.0, 1e-12);
  EXPECT_NEAR(spline.At(spline.length_m()).curvature_per_m, 0.0, 1e-9);
  const double step_m = 0.01;
  for (double s_m = step_m; s_m <= spline.length_m(); s_m += step_m) {
    const double rise_per_m =
        spline.At(s_m).curvature_per_m - spline.At(s_m - step_m).curvature_per_m;
    // The curvature of this course changes by less than 4e-4 /m^2.
    ASSERT_LE(std::abs(rise_per_m), 4e-4 * step_m);
  }
}

TEST(PlanSpline, ComesCloseToACircleThroughItsPoints) {
  const double radius_m = 400.0;
  std::vector<Eigen::Vector2d> points_m;
  for (double angle_rad = 0.0; angle_rad < 6.0; angle_rad += 0.1) {
    points_m.emplace_back(radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad));
  }
  const PlanSpline spline = Spline(points_m);
  const PlanPoint middle = spline.At(0.5 * spline.length_m());
  // The curvature of a cubic spline has a relative error of order (step / radius)^2 / 12 = 8e-4.
  EXPECT_NEAR(middle.curvature_per_m, 1.0 / radius_m, 1e-3 / radius_m);
  EXPECT_NEAR(std::hypot(middle.x_m, middle.y_m), radius_m, 1e-3);
  // More than half a turn: the heading is continuous.
  EXPECT_GT(spline.At(spline.length_m()).heading_rad, 1.5 * std::numbers::pi);
}

TEST(PlanSpline, RefusesPointsThatReverse) {
  EXPECT_THAT(SplineFaults({{0, 0}, {100, 0}, {50, 0}}),
              testing::ElementsAre(
                  "/course/points_m/0: the spline must not have a cusp between this point and the "
                  "next, its radius be at least 10 m (got 0)"));
}

TEST(PlanSpline, RefusesATurnTighterThanAnyRailway) {
  EXPECT_THAT(SplineFaults({{0, 0}, {20, 0}, {22, 2}, {20, 4}, {0, 4}}),
              testing::Contains(testing::StartsWith(
                  "/course/points_m/1: the spline must not have a cusp between this point")));
}

TEST(PlanSpline, RefusesCoincidentPoints) {
  EXPECT_THAT(SplineFaults({{0, 0}, {100, 0}, {100, 0}}),
              testing::ElementsAre(
                  "/course/points_m/2: must be at least 0.001 m from the point before (got 0)"));
}

TEST(PlanSpline, RefusesASinglePoint) {
  EXPECT_THAT(SplineFaults({{3, 4}}),
              testing::ElementsAre("/course/points_m: must have at least 2 points (got 1)"));
}

}  // namespace
}  // namespace railcast
