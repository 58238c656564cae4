#include "core/io/scan_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <vector>

#include "core/io/kitti.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

TEST(ScanMotion, PutsWhatStandsWhereItWasSeenAtTheStamp) {
  // During the scan the sensor moves 3 m ahead on an arc and turns 6 deg to the left.
  constexpr double kTurn_rad = 0.1;
  constexpr double kRadius_m = 3.0 / kTurn_rad;
  const Transform world_from_stamp =
      MakeTransform(RotationFromYawPitchRoll(2.0, 0.01, 0.05), Vector3(5.3e6, 6e5, 400));
  const auto stamp_from_sensor = [&](double share) {
    const double turn_rad = share * kTurn_rad;
    return MakeTransform(RotationFromYawPitchRoll(turn_rad, 0, 0),
                         kRadius_m * Vector3(std::sin(turn_rad), 1.0 - std::cos(turn_rad), 0));
  };
  Frame frame;
  frame.duration_ns = 100'000'000;
  frame.world_from_sensor = world_from_stamp;
  frame.world_from_sensor_end = world_from_stamp * stamp_from_sensor(1.0);
  const ScanMotion motion(frame);
  const Vector3 seen_at_stamp(80.0, -7.0, 1.5);
  for (const double share : {0.0, 0.25, 0.5, 1.0}) {
    const Vector3 seen = stamp_from_sensor(share).inverse() * seen_at_stamp;
    const auto time_ns = static_cast<std::uint32_t>(share * 1e8);
    // ScanMotion follows the chord instead of the arc, which is off by turn x path / 8 = 37.5 mm in
    // the middle; 10 % are added.
    const double tolerance_m = 1e-7 + 1.1 * 4.0 * share * (1.0 - share) * 3.0 * kTurn_rad / 8.0;
    EXPECT_LT((motion.AtStamp(seen, time_ns) - seen_at_stamp).norm(), tolerance_m) << share;
  }
}

TEST(ScanMotion, LeavesPointsOfAScanOfOneMoment) {
  Frame frame;
  frame.world_from_sensor_end.translation() = Vector3(1, 0, 0);
  EXPECT_EQ(ScanMotion(frame).AtStamp(Vector3(3, 4, 5), 0), Vector3(3, 4, 5));
}

std::vector<float> KittiX(const Frame& frame) {
  std::string bytes;
  EncodeKittiPoints(frame, bytes);
  std::vector<float> x(bytes.size() / 16);
  for (std::size_t i = 0; i < x.size(); ++i) std::memcpy(&x[i], bytes.data() + 16 * i, 4);
  return x;
}

TEST(ScanMotion, FlattensAWallForKittiThatAMovingSensorSeesSlanted) {
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts.push_back({MakeWall(60.0F, 50.0F), 3, 1});
  world->velocity_chunk_mps = Vector3(30, 0, 0);
  const SimulatorSpec spec{.vehicle_from_sensor =
                               MakeTransform(Eigen::Matrix3d::Identity(), Vector3(2, 0, 2.5))};
  const Frame frame = ScanOnce(world, MakeRaster(60.0, 30.0, 0.5), spec, 5);
  ASSERT_EQ(std::count_if(frame.outcome.begin(), frame.outcome.end(), HasPoint),
            static_cast<std::ptrdiff_t>(frame.num_slots()));
  // At the stamp, 0.5 s, the wall is 60 - 15 - 2 m ahead; columns are fired until 0.1 s later.
  const auto [kitti_least, kitti_most] = std::ranges::minmax(KittiX(frame));
  EXPECT_NEAR(kitti_least, 43.0F, 2e-3F);
  EXPECT_NEAR(kitti_most, 43.0F, 2e-3F);
  // PCD and PLY hold x as it was measured.
  const auto [least, most] = std::ranges::minmax(frame.x);
  EXPECT_NEAR(most - least, 30.0 * frame.duration_ns * 1e-9, 2e-3);
  EXPECT_GT(frame.duration_ns, 90'000'000U);
}

}  // namespace
}  // namespace railcast
