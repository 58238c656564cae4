#include "core/rail/line/plan_course.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

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

}  // namespace
}  // namespace railcast
