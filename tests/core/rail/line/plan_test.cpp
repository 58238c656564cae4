#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/rail/line/plan_course.h"

namespace railcast {
namespace {

// Tolerance of coordinates, which are sums over some hundred nodes and reach kilometres.
constexpr double kPositionTolerance_m = 1e-9;

TEST(PlanCourse, IsAStraightLineWithoutCurvature) {
  const double heading_rad = 0.3;
  const PlanCourse course({{{0.0, 0.0, 0.0}}, 1000.0}, {5.0, -7.0, heading_rad, 0.0});
  const PlanPoint point = course.At(876.5);
  EXPECT_NEAR(point.x_m, 5.0 + 876.5 * std::cos(heading_rad), kPositionTolerance_m);
  EXPECT_NEAR(point.y_m, -7.0 + 876.5 * std::sin(heading_rad), kPositionTolerance_m);
  EXPECT_EQ(point.heading_rad, heading_rad);
}

class PlanCircle : public testing::TestWithParam<double> {};

TEST_P(PlanCircle, IsACircleOfItsRadius) {
  const double radius_m = GetParam();
  const double length_m = 2.0 * std::numbers::pi * std::abs(radius_m);
  const PlanCourse course({{{0.0, 1.0 / radius_m, 1.0 / radius_m}}, length_m}, {});
  for (double s_m = 0.0; s_m < length_m; s_m += length_m / 97.0) {
    const PlanPoint point = course.At(s_m);
    EXPECT_NEAR(point.x_m, radius_m * std::sin(s_m / radius_m), kPositionTolerance_m);
    EXPECT_NEAR(point.y_m, radius_m * (1.0 - std::cos(s_m / radius_m)), kPositionTolerance_m);
    EXPECT_NEAR(point.heading_rad, s_m / radius_m, 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(LeftAndRight, PlanCircle, testing::Values(10.0, -180.0, 300.0, -4000.0));

// Clothoid from the series of the Fresnel integrals (Abramowitz and Stegun 7.3.11, 7.3.13) for the
// heading t = s^2 / (2 A^2):
//
//     x = sum (-1)^n t^2n s / ((2n)! (4n + 1))
//     y = sum (-1)^n t^(2n+1) s / ((2n + 1)! (4n + 3))
PlanPoint Clothoid(double s_m, double parameter_m2) {
  const double heading_rad = s_m * s_m / (2.0 * parameter_m2);
  PlanPoint point{0.0, 0.0, heading_rad, s_m / parameter_m2};
  double term_m = s_m;
  for (int n = 0; n < 30; ++n) {
    const double sign = (n / 2) % 2 == 0 ? 1.0 : -1.0;
    (n % 2 == 0 ? point.x_m : point.y_m) += sign * term_m / (2.0 * n + 1.0);
    term_m *= heading_rad / (n + 1.0);
  }
  return point;
}

TEST(PlanCourse, FollowsTheFresnelIntegralsOnAClothoid) {
  const double length_m = 120.0;
  const double radius_m = 60.0;
  const PlanCourse course({{{0.0, 0.0, 1.0 / radius_m}}, length_m}, {});
  for (double s_m = 0.0; s_m <= length_m; s_m += 1.7) {
    const PlanPoint expected = Clothoid(s_m, radius_m * length_m);
    const PlanPoint point = course.At(s_m);
    EXPECT_NEAR(point.x_m, expected.x_m, kPositionTolerance_m) << "at " << s_m;
    EXPECT_NEAR(point.y_m, expected.y_m, kPositionTolerance_m) << "at " << s_m;
    EXPECT_NEAR(point.heading_rad, expected.heading_rad, 1e-13);
    EXPECT_NEAR(point.curvature_per_m, expected.curvature_per_m, 1e-15);
  }
}

TEST(PlanCourse, GoesOnWithoutAStepFromPieceToPiece) {
  const PlanCourse course(
      {{{0.0, 0.0, 0.0}, {33.3, 0.0, 0.005}, {90.0, 0.005, 0.005}, {300.0, 0.005, -0.003}}, 400.0},
      {});
  for (const double s_m : {33.3, 90.0, 300.0}) {
    const PlanPoint before = course.At(std::nextafter(s_m, 0.0));
    const PlanPoint after = course.At(s_m);
    EXPECT_NEAR(before.x_m, after.x_m, kPositionTolerance_m);
    EXPECT_NEAR(before.y_m, after.y_m, kPositionTolerance_m);
    EXPECT_NEAR(before.heading_rad, after.heading_rad, 1e-12);
    EXPECT_NEAR(before.curvature_per_m, after.curvature_per_m, 1e-12);
  }
}

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
