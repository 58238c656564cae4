#include "generator/record/pose_record.h"

#include <gtest/gtest.h>

namespace railcast {
namespace {

TEST(PoseLine, GivesTheSameDoublesBack) {
  const Transform world_from_sensor = MakeTransform(RotationFromYawPitchRoll(3.0, 0.01, -0.2),
                                                    Vector3(5.3e6 + 1.0 / 3.0, 6e5, 0.1));
  const PoseRecord pose(1'234'567'890'123LL, world_from_sensor);
  const PoseRecord back = ParsePoseLine(PoseLine(pose));
  EXPECT_EQ(back.stamp_ns, pose.stamp_ns);
  EXPECT_EQ(back.position_m, pose.position_m);
  EXPECT_EQ(back.rotation.coeffs(), pose.rotation.coeffs());
  // Converting a quaternion to a matrix rounds numbers of up to 1 several times.
  EXPECT_TRUE(back.WorldFromSensor().linear().isApprox(world_from_sensor.linear(), 1e-14));
}

TEST(PoseLine, IsStampPositionAndQuaternion) {
  EXPECT_EQ(
      PoseLine(PoseRecord(100, MakeTransform(Eigen::Matrix3d::Identity(), Vector3(1, 2.5, -3)))),
      "100,1,2.5,-3,0,0,0,1\n");
}

TEST(CanonicalRotation, HasAPositiveRealPart) {
  for (const double yaw_rad : {-3.1, -1.0, 0.0, 2.0, 3.1}) {
    const Transform turn = MakeTransform(RotationFromYawPitchRoll(yaw_rad, 0, 0), Vector3::Zero());
    EXPECT_GE(CanonicalRotation(turn).w(), 0.0);
  }
}

}  // namespace
}  // namespace railcast
