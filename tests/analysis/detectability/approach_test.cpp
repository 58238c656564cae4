#include "analysis/detectability/approach.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/units.h"
#include "tests/analysis/detectability/made_track.h"

namespace railcast {
namespace {

const Vector3 kPerson_m(0.5, 0.6, 1.8);
const Vector3 kWagon_m(20.0, 3.0, 4.0);

/// A box standing at rail level, at a position and heading in the plane.
Transform BoxAt(double x_m, double y_m, const Vector3& size_m, double heading_rad = 0.0) {
  return MakeTransform(RotationFromYawPitchRoll(heading_rad, 0.0, 0.0),
                       Vector3(x_m, y_m, 0.5 * size_m.z()));
}

Transform VehicleAt(double x_m, double heading_rad = 0.0) {
  return MakeTransform(RotationFromYawPitchRoll(heading_rad, 0.0, 0.0), Vector3(x_m, 0.0, 0.0));
}

bool IsInWay(double x_m, double y_m, double heading_rad = 0.0) {
  return StraightTrack()
      .ClearanceAhead(VehicleAt(500.0, heading_rad), BoxAt(x_m, y_m, kPerson_m), kPerson_m)
      .is_inside;
}

TEST(OwnTrack, HasInItsWayWhatReachesIntoTheGaugeAhead) {
  EXPECT_TRUE(IsInWay(600.0, 0.0));
  EXPECT_TRUE(IsInWay(600.0, 1.574 + 0.3));
  EXPECT_FALSE(IsInWay(600.0, 1.576 + 0.3));
  EXPECT_FALSE(IsInWay(600.0, 4.0)) << "on the second track";
  EXPECT_NEAR(StraightTrack()
                  .ClearanceAhead(VehicleAt(500.0), BoxAt(600.0, -2.4, kPerson_m), kPerson_m)
                  .from_axis_m,
              2.1, 1e-9);
}

TEST(OwnTrack, IsTheWayThatTheVehicleGoes) {
  EXPECT_FALSE(IsInWay(400.0, 0.0)) << "behind";
  EXPECT_TRUE(IsInWay(400.0, 0.0, std::numbers::pi)) << "in reverse";
  EXPECT_FALSE(IsInWay(600.0, 0.0, std::numbers::pi));
  EXPECT_FALSE(IsInWay(2'010.0, 0.0)) << "beyond the track's end";
}

// At 300 m along a curve of 300 m radius the track lies 138 m to the left of the tangent.
TEST(OwnTrack, FollowsTheCurve) {
  constexpr double kRadius_m = 300.0;
  const OwnTrack track(ScenarioOn(ElementType::kArc, 800.0, kRadius_m));
  const auto at = [&](double s_m, double d_m, const Vector3& size_m) {
    const double angle_rad = s_m / kRadius_m;
    const double radius_m = kRadius_m - d_m;
    return track.ClearanceAhead(
        VehicleAt(0.0),
        BoxAt(radius_m * std::sin(angle_rad), kRadius_m - radius_m * std::cos(angle_rad), size_m,
              angle_rad),
        size_m);
  };
  EXPECT_TRUE(at(300.0, 0.0, kPerson_m).is_inside);
  EXPECT_NEAR(at(300.0, 3.0, kPerson_m).from_axis_m, 2.7, 0.01);
  const auto straight_ahead =
      track.ClearanceAhead(VehicleAt(0.0), BoxAt(280.0, 0.0, kPerson_m), kPerson_m);
  EXPECT_FALSE(straight_ahead.is_inside);
  // The ends of a wagon are 10^2 / (2 R) = 0.17 m farther out than its middle, so they are nearer
  // to the axis if it stands inside the curve.
  const GaugeClearance inside = at(300.0, 4.0, kWagon_m);
  EXPECT_FALSE(inside.is_inside);
  EXPECT_NEAR(inside.from_axis_m, 4.0 - 1.5 - 0.167, 0.01);
  EXPECT_NEAR(at(300.0, -4.0, kWagon_m).from_axis_m, 4.0 - 1.5, 0.01);
}

}  // namespace
}  // namespace railcast
