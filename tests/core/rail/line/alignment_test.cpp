#include "railcast/alignment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/support/alignment_faults.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

AlignmentSpec Straight(double length_m) {
  return AlignmentOf({{ElementType::kStraight, length_m, {}}});
}

/// Straight, clothoid, arc to the left, clothoid, straight: 100 m each.
AlignmentSpec LeftCurve(double radius_m) {
  AlignmentSpec spec = AlignmentOf({{ElementType::kStraight, 100.0, {}},
                                    {ElementType::kClothoid, 100.0, {}},
                                    {ElementType::kArc, 100.0, radius_m},
                                    {ElementType::kClothoid, 100.0, {}},
                                    {ElementType::kStraight, 100.0, {}}});
  spec.speed_limits_kmph = {{0.0, 80.0}};
  return spec;
}

TEST(Alignment, BeginsAtItsOriginWithItsHeading) {
  AlignmentSpec spec = Straight(100.0);
  spec.origin_m = {1000.0, -2000.0, 300.0};
  spec.heading_deg = 90.0;
  const AxisPoint point = Alignment(spec).At(40.0);
  EXPECT_TRUE(point.position_m.isApprox(Vector3(1000.0, -1960.0, 300.0), 1e-12));
  EXPECT_DOUBLE_EQ(point.heading_rad, 0.5 * std::numbers::pi);
}

TEST(Alignment, LeadsAClothoidFromTheCurvatureBeforeToTheOneAfter) {
  const Alignment alignment(LeftCurve(400.0));
  EXPECT_EQ(alignment.length_m(), 500.0);
  EXPECT_DOUBLE_EQ(alignment.At(150.0).curvature_per_m, 0.5 / 400.0);
  EXPECT_DOUBLE_EQ(alignment.At(250.0).curvature_per_m, 1.0 / 400.0);
  EXPECT_DOUBLE_EQ(alignment.At(375.0).curvature_per_m, 0.25 / 400.0);
  EXPECT_DOUBLE_EQ(alignment.tightest_radius_m(), 400.0);
  EXPECT_THAT(alignment.smoothed_jumps(), testing::IsEmpty());
}

TEST(Alignment, LetsAClothoidAtAnEndBeginOrEndStraight) {
  const Alignment alignment(AlignmentOf({{ElementType::kClothoid, 50.0, {}},
                                         {ElementType::kArc, 100.0, -300.0},
                                         {ElementType::kClothoid, 50.0, {}}}));
  EXPECT_EQ(alignment.At(0.0).curvature_per_m, 0.0);
  EXPECT_DOUBLE_EQ(alignment.At(25.0).curvature_per_m, -0.5 / 300.0);
  EXPECT_NEAR(alignment.At(200.0).curvature_per_m, 0.0, 1e-15);
}

TEST(Alignment, SmoothsAJumpOfCurvatureAndListsIt) {
  const Alignment alignment(
      AlignmentOf({{ElementType::kStraight, 100.0, {}}, {ElementType::kArc, 100.0, 500.0}}));
  EXPECT_DOUBLE_EQ(alignment.At(90.0).curvature_per_m, 0.0);
  EXPECT_DOUBLE_EQ(alignment.At(100.0).curvature_per_m, 0.001);
  EXPECT_DOUBLE_EQ(alignment.At(110.0).curvature_per_m, 0.002);
  ASSERT_EQ(alignment.smoothed_jumps().size(), 1U);
  EXPECT_EQ(alignment.smoothed_jumps()[0].quantity, "curvature");
  EXPECT_EQ(alignment.smoothed_jumps()[0].s_m, 100.0);
  EXPECT_EQ(alignment.smoothed_jumps()[0].length_m, 20.0);
  // The total change of heading is the same as without smoothing.
  EXPECT_NEAR(alignment.At(200.0).heading_rad, 100.0 / 500.0, 1e-12);
}

TEST(Alignment, RisesByTheIntegralOfItsGradient) {
  AlignmentSpec spec = Straight(1000.0);
  spec.gradients_permil = {{0.0, 10.0}, {400.0, -5.0}};
  const Alignment alignment(spec);
  EXPECT_DOUBLE_EQ(alignment.At(300.0).position_m.z(), 3.0);
  EXPECT_DOUBLE_EQ(alignment.At(300.0).gradient, 0.010);
  // A parabola from 380 to 420 m: halfway the gradient is the mean, and the height beyond is
  // unaffected.
  EXPECT_DOUBLE_EQ(alignment.At(400.0).gradient, 0.0025);
  EXPECT_NEAR(alignment.At(400.0).position_m.z(), 3.8 + 20.0 * 0.5 * (0.010 + 0.0025), 1e-12);
  EXPECT_NEAR(alignment.At(1000.0).position_m.z(), 4.0 - 3.0, 1e-12);
  ASSERT_EQ(alignment.smoothed_jumps().size(), 1U);
  EXPECT_EQ(alignment.smoothed_jumps()[0].quantity, "gradient");
  EXPECT_EQ(alignment.smoothed_jumps()[0].before, 10.0);
  EXPECT_EQ(alignment.smoothed_jumps()[0].after, -5.0);
}

TEST(Alignment, GoesOnStraightAndLevelBeyondItsEnds) {
  AlignmentSpec spec =
      AlignmentOf({{ElementType::kArc, 157.07963267948966, 100.0}});  // A quarter circle.
  spec.gradients_permil = {{0.0, 20.0}};
  const Alignment alignment(spec);
  const AxisPoint before = alignment.At(-30.0);
  EXPECT_TRUE(before.position_m.isApprox(Vector3(-30.0, 0.0, 0.0), 1e-9));
  EXPECT_EQ(before.gradient, 0.0);
  EXPECT_EQ(before.curvature_per_m, 0.0);
  const AxisPoint beyond = alignment.At(alignment.length_m() + 30.0);
  EXPECT_TRUE(beyond.position_m.isApprox(Vector3(100.0, 130.0, 0.02 * alignment.length_m()), 1e-9));
  EXPECT_NEAR(beyond.heading_rad, 0.5 * std::numbers::pi, 1e-12);
}

TEST(Alignment, TakesCantByRuleFromCurvatureAndSpeed) {
  const Alignment alignment(LeftCurve(400.0));
  // 11.8 x 80^2 / 400 - 60 = 128.8 mm over 1500 mm, constant within 30 m of the middle.
  const double cant_rad = std::asin(128.8 / 1500.0);
  EXPECT_NEAR(alignment.At(250.0).cant_rad, -cant_rad, 1e-12);
  EXPECT_EQ(alignment.At(50.0).cant_rad, 0.0);
}

TEST(Alignment, LimitsCantToItsMaximum) {
  const Alignment alignment(LeftCurve(200.0));  // The rule alone would give 317.6 mm.
  EXPECT_NEAR(alignment.At(250.0).cant_rad, -std::asin(150.0 / 1500.0), 1e-12);
}

TEST(Alignment, PutsTracksSideBySideAtOneHeight) {
  const Alignment line(LeftCurve(400.0));
  const Transform axis = line.WorldFromTrack(250.0);
  const Transform second = line.WorldFromTrack(250.0, 4.0);
  EXPECT_NEAR(second.translation().z(), axis.translation().z(), 1e-12);
  EXPECT_NEAR((second.translation() - axis.translation()).norm(), 4.0, 1e-12);
  EXPECT_TRUE(second.linear().isApprox(axis.linear(), 1e-12));
}

TEST(Alignment, LeansIntoTheCurve) {
  // The outer rail is the higher one: the right rail in a left curve.
  const Alignment left(LeftCurve(400.0));
  EXPECT_GT((left.WorldFromTrack(250.0) * Vector3(0.0, -0.75, 0.0)).z(), 0.06);
  EXPECT_LT((left.WorldFromTrack(250.0) * Vector3(0.0, 0.75, 0.0)).z(), -0.06);
  const Alignment right(LeftCurve(-400.0));
  EXPECT_LT((right.WorldFromTrack(250.0) * Vector3(0.0, -0.75, 0.0)).z(), -0.06);
  EXPECT_GT((right.WorldFromTrack(250.0) * Vector3(0.0, 0.75, 0.0)).z(), 0.06);
}

TEST(Alignment, RampsCantWithoutAStep) {
  AlignmentSpec spec = LeftCurve(400.0);
  spec.speed_limits_kmph = {{0.0, 80.0}, {250.0, 50.0}};  // 128.8 mm, then 13.75 mm.
  const Alignment alignment(spec);
  EXPECT_NEAR(alignment.At(250.0).cant_rad, -std::asin(0.5 * (128.8 + 13.75) / 1500.0), 1e-12);
  // Full cant within one ramp length.
  const double steepest_rad_per_m = 1.01 * 150.0 / 60.0 / 1500.0;
  for (double s_m = 0.01; s_m < 500.0; s_m += 0.01) {
    ASSERT_LE(std::abs(alignment.At(s_m).cant_rad - alignment.At(s_m - 0.01).cant_rad),
              steepest_rad_per_m * 0.01);
  }
}

TEST(Alignment, TakesSurveyedCantInPlaceOfTheRule) {
  AlignmentSpec spec = LeftCurve(400.0);
  spec.cants_mm = {{0.0, 0.0}, {100.0, 0.0}, {140.0, 100.0}, {400.0, 100.0}};
  const Alignment alignment(spec);
  EXPECT_EQ(alignment.At(100.0).cant_rad, 0.0);
  EXPECT_NEAR(alignment.At(130.0).cant_rad, -std::asin(75.0 / 1500.0), 1e-12);
  EXPECT_NEAR(alignment.At(250.0).cant_rad, -std::asin(100.0 / 1500.0), 1e-12);
  EXPECT_NEAR(alignment.At(450.0).cant_rad, -std::asin(100.0 / 1500.0), 1e-12);
  // The right rail is the higher one.
  EXPECT_NEAR((alignment.WorldFromTrack(250.0) * Vector3(0.0, -0.75, 0.0)).z(), 0.05, 1e-12);
}

TEST(Alignment, MeasuresCantAcrossTheRailHeadsOfItsGauge) {
  AlignmentSpec spec = LeftCurve(400.0);
  spec.gauge_mm = 1000.0;
  // 11.8 x 1065 / 1500 x 80^2 / 400 - 60 = 74.048 mm over 1065 mm.
  EXPECT_NEAR(Alignment(spec).At(250.0).cant_rad, -std::asin(74.048 / 1065.0), 1e-12);
  spec.cants_mm = {{0.0, 100.0}};
  EXPECT_NEAR(Alignment(spec).At(250.0).cant_rad, -std::asin(100.0 / 1065.0), 1e-12);
  spec.gauge_mm = 599.0;
  EXPECT_EQ(FaultOf(spec), "/gauge_mm: must be from 600 to 1700 (got 599)");
}

TEST(Alignment, HasNoCantAndNoLimitWithoutSpeedLimits) {
  AlignmentSpec spec = LeftCurve(400.0);
  spec.speed_limits_kmph.clear();
  const Alignment alignment(spec);
  EXPECT_EQ(alignment.At(250.0).cant_rad, 0.0);
  EXPECT_EQ(alignment.SpeedLimitMps(250.0), std::numeric_limits<double>::infinity());
  EXPECT_DOUBLE_EQ(Alignment(LeftCurve(400.0)).SpeedLimitMps(250.0), 80.0 / 3.6);
}

TEST(Alignment, PutsTheTrackFrameOnTheAxis) {
  AlignmentSpec spec = Straight(1000.0);
  spec.heading_deg = 30.0;
  spec.gradients_permil = {{0.0, 25.0}};
  const Alignment alignment(spec);
  const double step_m = 1e-4;
  const Vector3 along =
      (alignment.At(500.0 + step_m).position_m - alignment.At(500.0).position_m).normalized();
  const Transform world_from_track = alignment.WorldFromTrack(500.0, 2.0, 1.0);
  EXPECT_TRUE(world_from_track.linear().col(0).isApprox(along, 1e-8));
  const Vector3 offset = world_from_track.translation() - alignment.At(500.0).position_m;
  EXPECT_NEAR(offset.dot(along), 0.0, 1e-8);
  EXPECT_NEAR(offset.dot(Vector3(-0.5, std::sqrt(0.75), 0.0)), 2.0, 1e-12);
  EXPECT_NEAR(offset.norm(), std::sqrt(5.0), 1e-12);
}

TEST(Alignment, PutsASplinesPointsByOriginAndHeading) {
  AlignmentSpec spec;
  spec.course = AlignmentSplineSpec{{{10.0, 0.0}, {110.0, 0.0}}};
  spec.origin_m = {1000.0, 2000.0, 30.0};
  spec.heading_deg = 90.0;
  const Alignment alignment(spec);
  EXPECT_NEAR(alignment.length_m(), 100.0, 1e-9);
  EXPECT_TRUE(alignment.At(50.0).position_m.isApprox(Vector3(1000.0, 2060.0, 30.0), 1e-12));
}

TEST(Alignment, CantsASplineByItsCurvature) {
  AlignmentSplineSpec course;
  for (double angle_rad = 0.0; angle_rad < 2.0; angle_rad += 0.1) {
    course.points_m.push_back({400.0 * std::sin(angle_rad), 400.0 * (1.0 - std::cos(angle_rad))});
  }
  AlignmentSpec spec;
  spec.course = course;
  spec.speed_limits_kmph = {{0.0, 80.0}};
  const Alignment alignment(spec);
  // The spline's curvature has a relative error of 1e-3: 0.2 mm of cant.
  EXPECT_NEAR(1500.0 * std::sin(alignment.At(400.0).cant_rad), -128.8, 0.2);
}

TEST(Alignment, ReportsEveryFaultAtOnce) {
  AlignmentSpec spec;
  spec.course = AlignmentSectionsSpec{100.0, {{5.0, 3.0, {}}, {5.0, {}, -9.5}, {120.0, {}, {}}}};
  spec.gradients_permil = {{0.0, 1.0}, {-1.0, 2.0}};
  spec.speed_limits_kmph = {{0.0, 0.0}};
  spec.cants_mm = {{0.0, -301.0}};
  spec.cant_ramp_m = 0.0;
  EXPECT_EQ(FaultOf(spec),
            "/cant_ramp_m: must be > 0 (got 0)\n"
            "/speed_limits_kmph/0/value: must be > 0 (got 0)\n"
            "/cants_mm/0/value: must be from -300 to 300 (got -301)\n"
            "/course/sections/0/s_m: must be 0, the beginning of the line (got 5)\n"
            "/course/sections/1/s_m: must be greater than 5 before it (got 5)\n"
            "/course/sections/2/s_m: must be less than the line's length of 100 m (got 120)\n"
            "/course/sections/0/radius_start_m: must be at least 10 m, negative to the right, "
            "absent where straight (got 3)\n"
            "/course/sections/1/radius_end_m: must be at least 10 m, negative to the right, "
            "absent where straight (got -9.5)\n"
            "/gradients_permil/1/s_m: must be greater than 0 before it (got -1)");
}

TEST(Alignment, RefusesElementsThatMakeNoLine) {
  AlignmentSpec spec = AlignmentOf({{ElementType::kStraight, 0.0, 500.0},
                                    {ElementType::kArc, 10.0, {}},
                                    {ElementType::kClothoid, 10.0, {}},
                                    {ElementType::kClothoid, 10.0, {}}});
  EXPECT_EQ(FaultOf(spec),
            "/course/elements/0/length_m: must be > 0 (got 0)\n"
            "/course/elements/0/radius_m: is for arcs only (got 500)\n"
            "/course/elements/1/radius_m: is required for an arc (got none)\n"
            "/course/elements/3/type: must not be clothoid after a clothoid (put an arc or a "
            "straight between them)");
}

TEST(Alignment, RefusesACourseWithoutAnything) {
  AlignmentSpec spec;
  spec.course = AlignmentElementsSpec{};
  EXPECT_EQ(FaultOf(spec), "/course/elements: must have at least one element (got none)");
  spec.course = AlignmentSectionsSpec{};
  EXPECT_EQ(FaultOf(spec),
            "/course/length_m: must be > 0 (got 0)\n"
            "/course/sections: must have at least one section (got none)");
}

TEST(Alignment, RefusesFiguresBeyondTheEndOfTheLine) {
  AlignmentSpec spec = Straight(100.0);
  spec.speed_limits_kmph = {{0.0, 80.0}, {100.0, 60.0}};
  spec.cants_mm = {{0.0, 0.0}, {120.0, 60.0}};
  EXPECT_EQ(FaultOf(spec),
            "/speed_limits_kmph/1/s_m: must be less than the line's length of 100 m (got 100)\n"
            "/cants_mm/1/s_m: must be less than the line's length of 100 m (got 120)");
}

}  // namespace
}  // namespace railcast
