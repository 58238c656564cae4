#include "core/io/cloud/scan_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "core/io/cloud/kitti.h"
#include "core/io/write_file.h"
#include "core/simulate/frame_poses.h"
#include "railcast/scenario.h"
#include "tests/core/io/temporary_directory.h"
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
  const Vector3 seen_at_stamp(80.0, -7.0, 1.5);
  // With poses in between, the chords are a third as long.
  frame.poses_between = {{33'333'333, world_from_stamp * stamp_from_sensor(0.33333333)},
                         {66'666'667, world_from_stamp * stamp_from_sensor(0.66666667)}};
  const ScanMotion of_four(frame);
  for (const double share : {0.0, 0.2, 0.5, 0.9, 1.0}) {
    const Vector3 seen = stamp_from_sensor(share).inverse() * seen_at_stamp;
    const auto time_ns = static_cast<std::uint32_t>(share * 1e8);
    const double tolerance_m = 1e-7 + 1.1 * 3.0 * kTurn_rad / 8.0 / 9.0;
    EXPECT_LT((of_four.AtStamp(seen, time_ns) - seen_at_stamp).norm(), tolerance_m) << share;
    EXPECT_LT((of_four.AtFiring(of_four.AtStamp(seen, time_ns), time_ns) - seen).norm(), 1e-9);
  }
  frame.poses_between.clear();
  const ScanMotion motion(frame);
  for (const double share : {0.0, 0.25, 0.5, 1.0}) {
    const Vector3 seen = stamp_from_sensor(share).inverse() * seen_at_stamp;
    const auto time_ns = static_cast<std::uint32_t>(share * 1e8);
    // ScanMotion follows the chord instead of the arc, which is off by turn x path / 8 = 37.5 mm in
    // the middle; 10 % are added.
    const double tolerance_m = 1e-7 + 1.1 * 4.0 * share * (1.0 - share) * 3.0 * kTurn_rad / 8.0;
    EXPECT_LT((motion.AtStamp(seen, time_ns) - seen_at_stamp).norm(), tolerance_m) << share;
    EXPECT_LT((motion.AtFiring(motion.AtStamp(seen, time_ns), time_ns) - seen).norm(), 1e-9);
  }
}

/// A vehicle that runs at one speed from the chainage on, by the text of `world` and `route`.
std::unique_ptr<Simulator> RunAt(double speed_mps,
                                 const std::string& alignment,
                                 const std::string& more = "",
                                 const std::string& vehicle = "") {
  const std::string scenarios = RAILCAST_SOURCE_DIR "/scenarios/";
  const TemporaryDirectory folder;
  const auto file = folder.path() / "scenario.json";
  WriteFileWhole(
      file, R"({"version": 1, "file": ")" + scenarios + R"(minimal.json", "lidar": {"file": ")" +
                scenarios + R"(sensors/vir2rail.json", "mount": {"position_m": [2.2, 0, 2.5]}}, )" +
                R"("world": {"alignment": {"course": {"type": "elements", "elements": [)" +
                alignment + "]}}" + more + R"(}, "vehicle": {"start_s_m": 110, )" + vehicle +
                R"("motion": {"profile": [{"time_s": 0, "speed_mps": )" +
                std::to_string(speed_mps) + "}]}}}");
  return MakeSimulator(ReadScenario(file), 1);
}

struct Residuals {
  double of_two_poses_m{};
  double of_recorded_poses_m{};
};

/// How far compensation leaves points 50 m ahead, beside and above from where they are, at most,
/// in scans of 0.1 s that begin everywhere on the way.
Residuals LeftOver(const Simulator& simulator, double duration_s) {
  constexpr std::uint32_t kScan_ns = 100'000'000;
  constexpr double kDistance_m = 50.0;
  Residuals most;
  Frame frame;
  frame.duration_ns = kScan_ns;
  for (std::int64_t stamp_ns = 0; stamp_ns < static_cast<std::int64_t>(1e9 * duration_s);
       stamp_ns += 7'000'000) {
    const auto pose = [&](std::uint32_t time_ns) {
      return simulator.WorldFromSensor(stamp_ns + time_ns);
    };
    frame.world_from_sensor = pose(0);
    frame.world_from_sensor_end = pose(kScan_ns);
    frame.poses_between.clear();
    const ScanMotion of_two(frame);
    frame.poses_between = PosesBetween(kScan_ns, pose);
    const ScanMotion of_recorded(frame);
    for (std::uint32_t time_ns = 0; time_ns <= kScan_ns; time_ns += kScan_ns / 20) {
      const Transform stamp_from_sensor = pose(0).inverse() * pose(time_ns);
      for (int axis = 0; axis < 3; ++axis) {
        const Vector3 seen = kDistance_m * Vector3::Unit(axis);
        const Vector3 at_stamp = stamp_from_sensor * seen;
        most.of_two_poses_m =
            std::max(most.of_two_poses_m, (of_two.AtStamp(seen, time_ns) - at_stamp).norm());
        most.of_recorded_poses_m = std::max(most.of_recorded_poses_m,
                                            (of_recorded.AtStamp(seen, time_ns) - at_stamp).norm());
      }
    }
  }
  return most;
}

// The sagitta of an arc: (33.3 m/s x 0.1 s)^2 / (8 R), and a 25th of it.
TEST(ScanMotion, LeavesLessThanAMillimetreInCurvesAt120Kmph) {
  for (const double radius_m : {300.0, 500.0}) {
    const auto simulator = RunAt(120.0 / 3.6, R"({"type": "arc", "length_m": 600, "radius_m": )" +
                                                  std::to_string(radius_m) + "}");
    const double sagitta_m = std::pow(120.0 / 3.6 * 0.1, 2) / (8.0 * radius_m);
    const Residuals most = LeftOver(*simulator, 0.2);
    EXPECT_NEAR(most.of_two_poses_m, sagitta_m, 0.02 * sagitta_m) << radius_m;
    EXPECT_NEAR(most.of_recorded_poses_m, sagitta_m / 25.0, 0.05 * sagitta_m / 25.0) << radius_m;
  }
}

// A turnout has no transition curves: the vehicle's yaw rate changes within its pivot distance. At
// 80 km/h, twice the speed of a 1:9-190, two poses leave 20 mm at 50 m.
TEST(ScanMotion, LeavesLessThanAMillimetreInATurnoutAtTwiceItsSpeed) {
  const auto simulator =
      RunAt(80.0 / 3.6, R"({"type": "straight", "length_m": 600})",
            R"(, "tracks": [{"name": "main"}, {"name": "side", "offset_m": -4.75, "begin": )"
            R"({"track": "main", "s_m": 120, "turnout": "1:9-190", "side": "right"}}])",
            R"("route": ["main", "side"], )");
  const Residuals most = LeftOver(*simulator, 4.0);
  EXPECT_GT(most.of_two_poses_m, 0.018);
  EXPECT_LT(most.of_two_poses_m, 0.022);
  EXPECT_LT(most.of_recorded_poses_m, 0.001);
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
