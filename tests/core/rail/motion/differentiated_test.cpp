#include "core/rail/motion/track_path.h"

#include <gtest/gtest.h>

#include <cmath>

namespace railcast {
namespace {

// A wave of amplitude 1 m, at whose phases a derivative is sought.
RigidMotion OfWave(double rad_per_s, double phase_rad) {
  return Differentiated([=](double after_s) {
    return MakeTransform(Eigen::Matrix3d::Identity(),
                         {std::sin(rad_per_s * after_s + phase_rad), 0.0, 0.0});
  });
}

TEST(Differentiated, AWaveIsWrongByNoMoreThanItsHeaderSays) {
  for (const double rad_per_s : {1.0, 6.3, 20.0, 84.0}) {
    const double order = std::pow(rad_per_s * kDifference_s, 4);
    for (const double phase_rad : {0.0, 0.5, 1.57, 2.9}) {
      const RigidMotion motion = OfWave(rad_per_s, phase_rad);
      EXPECT_NEAR(motion.velocity_mps.x(), rad_per_s * std::cos(phase_rad),
                  rad_per_s * order / 30.0 + 1e-12);
      EXPECT_NEAR(motion.acceleration_mps2.x(), -rad_per_s * rad_per_s * std::sin(phase_rad),
                  rad_per_s * rad_per_s * order / 90.0 + 1e-10);
    }
  }
  // The bounds are those of the difference formulas, not of something worse.
  const double order = std::pow(84.0 * kDifference_s, 4);
  EXPECT_GT(std::abs(OfWave(84.0, 0.0).velocity_mps.x() - 84.0), 84.0 * order / 40.0);
}

TEST(Differentiated, RoundingFarFromTheOriginAddsNoMoreThanItsHeaderSays) {
  constexpr double kFar_m = 60'000.0;
  const double rounding_m = std::ldexp(1.0, -53) * 65'536.0;
  for (int i = 0; i < 200; ++i) {
    const double speed_mps = 20.0 + 0.1 * i;
    const RigidMotion motion = Differentiated([&](double after_s) {
      return MakeTransform(Eigen::Matrix3d::Identity(), {kFar_m + speed_mps * after_s, 0.0, 0.0});
    });
    EXPECT_NEAR(motion.acceleration_mps2.x(), 0.0,
                5.4 * rounding_m / (kDifference_s * kDifference_s));
    EXPECT_NEAR(motion.velocity_mps.x(), speed_mps, 1e-8);
  }
  EXPECT_LT(5.4 * rounding_m / (kDifference_s * kDifference_s), 3e-6);
}

// A body that turns about z at the rate a and meanwhile rolls about its own x at the rate b: its
// angular velocity is a z + b x, and its angular acceleration that of the turning x, a b (z cross
// x).
TEST(Differentiated, HasTheAngularVelocityAndAccelerationInWorldAxes) {
  constexpr double kTurn_radps = 0.8;
  constexpr double kRoll_radps = -1.7;
  for (const double time_s : {0.0, 1.3, 50.0}) {
    const RigidMotion motion = Differentiated([&](double after_s) {
      const double at_s = time_s + after_s;
      return MakeTransform(RotationFromYawPitchRoll(kTurn_radps * at_s, 0.0, kRoll_radps * at_s),
                           Vector3::Zero());
    });
    const Vector3 x(std::cos(kTurn_radps * time_s), std::sin(kTurn_radps * time_s), 0.0);
    const Vector3 z = Vector3::UnitZ();
    EXPECT_LT((motion.angular_velocity_radps - kTurn_radps * z - kRoll_radps * x).norm(), 1e-9);
    EXPECT_LT((motion.angular_acceleration_radps2 - kTurn_radps * kRoll_radps * z.cross(x)).norm(),
              1e-7);
  }
}

// Points of a turning body: a cross r, and w cross (w cross r).
TEST(RigidMotion, PointsMoveWithTheBody) {
  RigidMotion motion;
  motion.world_from_body =
      MakeTransform(RotationFromYawPitchRoll(std::acos(0.0), 0.0, 0.0), {5.0, 6.0, 7.0});
  motion.velocity_mps = {1.0, 2.0, 3.0};
  motion.acceleration_mps2 = {0.1, 0.2, 0.3};
  motion.angular_velocity_radps = {0.0, 0.0, 2.0};
  motion.angular_acceleration_radps2 = {0.0, 0.0, 0.5};
  // In world axes the point (4, 0, 1) is at (0, 4, 1) from the origin.
  EXPECT_TRUE(motion.VelocityOf_mps({4.0, 0.0, 1.0}).isApprox(Vector3(1.0 - 8.0, 2.0, 3.0), 1e-14));
  EXPECT_TRUE(motion.AccelerationOf_mps2({4.0, 0.0, 1.0})
                  .isApprox(Vector3(0.1 - 2.0, 0.2 - 16.0, 0.3), 1e-14));
}

}  // namespace
}  // namespace railcast
