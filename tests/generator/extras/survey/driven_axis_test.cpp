#include "generator/extras/survey/driven_axis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/units.h"

namespace railcast {
namespace {

constexpr double kRadius_m = 400.0;

/// A place on a left curve far from the world's origin, on a gradient of 10 permil.
Transform PlaceOnCurve(double s_m) {
  const double turn_rad = s_m / kRadius_m;
  return MakeTransform(RotationFromYawPitchRoll(turn_rad, 0.0, 0.0),
                       {3.4e6 + kRadius_m * std::sin(turn_rad),
                        5.8e6 + kRadius_m * (1.0 - std::cos(turn_rad)), 120.0 + 0.01 * s_m});
}

/// Distance from a place to the axis, which is sampled every centimetre.
double DistanceTo_m(const Alignment& axis, const Vector3& place_m) {
  double least_m = 1e9;
  for (double s_m = 0.0; s_m < axis.length_m(); s_m += 0.01) {
    least_m = std::min(least_m, (axis.At(s_m).position_m - place_m).norm());
  }
  return least_m;
}

TEST(DrivenAxis, PassesWithinCentimetresOfEveryPlaceOfACurve) {
  DrivenWay way;
  for (int frame = 0; frame <= 60; ++frame)
    way.world_from_body.push_back(PlaceOnCurve(2.0 * frame));
  const Alignment axis(AxisAlong(way, 20.0).value());
  // A natural spline's chords of 8 m err by 1/384 h^4 of the fourth derivative; rounding the
  // gradients off over 8 m lifts the ends by 1 cm.
  constexpr double kTolerance_m = 0.03;
  for (int frame = 0; frame <= 60; frame += 12) {
    EXPECT_LT(DistanceTo_m(axis, PlaceOnCurve(2.0 * frame).translation()), kTolerance_m) << frame;
  }
  EXPECT_NEAR(axis.length_m(), 120.0 + 2.0 * 20.0, 0.1);
}

TEST(DrivenAxis, TakesWhatTwoRecordingsHaveDrivenFromTheFirst) {
  DrivenWay way;
  const auto drive = [&](int from_m, int to_m, double left_m) {
    for (int s_m = from_m; s_m <= to_m; ++s_m) {
      way.world_from_body.push_back(
          MakeTransform(Eigen::Matrix3d::Identity(), {1.0 * s_m, left_m, 0.0}));
    }
  };
  drive(0, 100, 0.0);
  drive(50, 200, 0.05);  // As far apart as poses may be.
  const Alignment axis(AxisAlong(way, 20.0).value());
  EXPECT_NEAR(axis.length_m(), 2.0 * 20.0 + 200.0, 8.0);
  EXPECT_NEAR(axis.At(20.0 + 75.0).position_m.y(), 0.0, 0.01);
  EXPECT_NEAR(axis.At(20.0 + 175.0).position_m.y(), 0.05, 0.01);
}

TEST(DrivenAxis, IsNoneWhereTheWayTurnsBack) {
  DrivenWay way;
  for (const double x_m : {100.0, 110.0, 120.0, 0.0, 10.0, 20.0}) {
    way.world_from_body.push_back(MakeTransform(Eigen::Matrix3d::Identity(), {x_m, 0.0, 0.0}));
  }
  EXPECT_FALSE(AxisAlong(way, 20.0));
}

TEST(DrivenAxis, IsBelowASensorByItsHeight) {
  DrivenWay way{.world_from_body = {}, .above_rail_m = 3.5};
  for (int frame = 0; frame <= 20; ++frame) {
    way.world_from_body.push_back(
        MakeTransform(Eigen::Matrix3d::Identity(), {1.0 * frame, 0.0, 10.0}));
  }
  EXPECT_NEAR(Alignment(AxisAlong(way, 20.0).value()).At(25.0).position_m.z(), 6.5, 1e-9);
}

TEST(DrivenAxis, OfASensorThatStandsLeadsWhereItLooks) {
  const DrivenWay way{.world_from_body{
      2,
      MakeTransform(RotationFromYawPitchRoll(0.5 * std::numbers::pi, 0.0, 0.0), {5.0, 6.0, 0.0})}};
  const Alignment axis(AxisAlong(way, 30.0).value());
  EXPECT_NEAR((axis.At(0.0).position_m - Vector3(5.0, -24.0, 0.0)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((axis.At(30.0).position_m - Vector3(5.0, 6.0, 0.0)).norm(), 0.0, 1e-6);
}

}  // namespace
}  // namespace railcast
