#include "railcast/transform.h"

#include <gtest/gtest.h>

#include <numbers>

namespace railcast {
namespace {

constexpr double kQuarterTurn_rad = std::numbers::pi / 2.0;

TEST(RotationFromYawPitchRoll, YawTurnsForwardToTheLeft) {
  const Vector3 turned = RotationFromYawPitchRoll(kQuarterTurn_rad, 0, 0) * Vector3::UnitX();
  EXPECT_TRUE(turned.isApprox(Vector3::UnitY(), 1e-12));
}

TEST(RotationFromYawPitchRoll, PositivePitchPointsTheNoseDown) {
  const Vector3 turned = RotationFromYawPitchRoll(0, 0.1, 0) * Vector3::UnitX();
  EXPECT_LT(turned.z(), 0.0);
}

TEST(RotationFromYawPitchRoll, PositiveRollRaisesTheLeftSide) {
  const Vector3 turned = RotationFromYawPitchRoll(0, 0, 0.1) * Vector3::UnitY();
  EXPECT_GT(turned.z(), 0.0);
}

}  // namespace
}  // namespace railcast
