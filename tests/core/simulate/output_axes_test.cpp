#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/simulate/frame_poses.h"
#include "railcast/simulator.h"
#include "tests/core/io/message_of.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

// A wall at x = 50 in a chunk that is turned left by 90 degrees and moved by (100, 200, 0): in the
// world, it stands at y = 250.
std::shared_ptr<SimpleWorld> TurnedWorld() {
  const auto world = WorldOfParts({{MakeWall(50.0F, 500.0F), 1, 1}});
  world->world_from_chunk =
      MakeTransform(RotationFromYawPitchRoll(std::numbers::pi / 2, 0, 0), {100.0, 200.0, 0.0});
  world->velocity_chunk_mps = {15.0, 0.0, 0.0};
  return world;
}

SimulatorSpec WithAxes(OutputFrame frame, Handedness handedness) {
  SimulatorSpec spec;
  spec.vehicle_from_sensor =
      MakeTransform(RotationFromYawPitchRoll(0.1, 0.05, 0.0), {2.0, 0.5, 3.0});
  spec.output = {frame, handedness};
  return spec;
}

TEST(OutputAxes, VehicleAxesAreMovedByTheMounting) {
  const ScanPattern pattern = MakeRaster(40, 10, 1);
  const Frame sensor =
      ScanOnce(TurnedWorld(), pattern, WithAxes(OutputFrame::kSensor, Handedness::kRight));
  const Frame vehicle =
      ScanOnce(TurnedWorld(), pattern, WithAxes(OutputFrame::kVehicle, Handedness::kRight));
  const Transform& vehicle_from_sensor =
      WithAxes(OutputFrame::kSensor, Handedness::kRight).vehicle_from_sensor;
  for (std::size_t slot = 0; slot < sensor.num_slots(); ++slot) {
    const Vector3 moved = vehicle_from_sensor * PointAt(sensor, slot);
    EXPECT_NEAR(static_cast<double>(vehicle.x[slot]), moved.x(), 1e-5);
    EXPECT_NEAR(static_cast<double>(vehicle.y[slot]), moved.y(), 1e-5);
    EXPECT_NEAR(static_cast<double>(vehicle.z[slot]), moved.z(), 1e-5);
  }
}

TEST(OutputAxes, WorldAxesShowTheWallWithoutMotionDistortion) {
  const Frame world = ScanOnce(TurnedWorld(), MakeRaster(40, 10, 1),
                               WithAxes(OutputFrame::kWorld, Handedness::kRight));
  for (std::size_t slot = 0; slot < world.num_slots(); ++slot) {
    EXPECT_NEAR(static_cast<double>(world.y[slot]), 250.0, 1e-4);
  }
}

TEST(OutputAxes, LeftHandednessNegatesY) {
  const ScanPattern pattern = MakeRaster(40, 10, 1);
  const Frame right =
      ScanOnce(TurnedWorld(), pattern, WithAxes(OutputFrame::kSensor, Handedness::kRight));
  const Frame left =
      ScanOnce(TurnedWorld(), pattern, WithAxes(OutputFrame::kSensor, Handedness::kLeft));
  for (std::size_t slot = 0; slot < right.num_slots(); ++slot) {
    EXPECT_EQ(left.x[slot], right.x[slot]);
    EXPECT_EQ(left.y[slot], -right.y[slot]);
  }
}

TEST(OutputAxes, WorldCoordinatesAreTakenAboutTheOriginThatIsGiven) {
  SimulatorSpec spec = WithAxes(OutputFrame::kWorld, Handedness::kRight);
  spec.output.origin_m = {60.0, 240.0, -1.0};
  const Frame world = ScanOnce(TurnedWorld(), MakeRaster(40, 10, 1), spec);
  for (std::size_t slot = 0; slot < world.num_slots(); ++slot) {
    EXPECT_NEAR(static_cast<double>(world.y[slot]), 10.0, 1e-5);
  }
}

// A sensor that is turned and moved in its mount measures what one with that mount would, and says
// that it is where it should be.
TEST(OutputAxes, AMountErrorMovesTheRaysButNoReportedPose) {
  auto world = TurnedWorld();
  world->velocity_chunk_mps = Vector3::Zero();
  const ScanPattern pattern = MakeRaster(40, 10, 1);
  SimulatorSpec nominal = WithAxes(OutputFrame::kSensor, Handedness::kRight);
  SimulatorSpec wrong = nominal;
  wrong.nominal_from_true =
      MakeTransform(RotationFromYawPitchRoll(0.02, -0.01, 0.03), {0.05, -0.02, 0.01});
  SimulatorSpec moved = nominal;
  moved.vehicle_from_sensor = nominal.vehicle_from_sensor * wrong.nominal_from_true;
  const Frame of_nominal = ScanOnce(world, pattern, nominal);
  const Frame of_wrong = ScanOnce(world, pattern, wrong);
  const Frame of_moved = ScanOnce(world, pattern, moved);
  EXPECT_TRUE(of_wrong.world_from_sensor.isApprox(of_nominal.world_from_sensor, 1e-12));
  EXPECT_TRUE(of_wrong.world_from_sensor_end.isApprox(of_nominal.world_from_sensor_end, 1e-12));
  SimulatorSpec in_vehicle = wrong;
  in_vehicle.output.frame = OutputFrame::kVehicle;
  SimulatorSpec in_world = wrong;
  in_world.output.frame = OutputFrame::kWorld;
  const Frame vehicle_points = ScanOnce(world, pattern, in_vehicle);
  const Frame world_points = ScanOnce(world, pattern, in_world);
  double farthest_m = 0.0;
  for (std::size_t slot = 0; slot < of_wrong.num_slots(); ++slot) {
    const Vector3 point = PointAt(of_wrong, slot);
    EXPECT_TRUE(point.isApprox(PointAt(of_moved, slot), 1e-6));
    farthest_m = std::max(farthest_m, (point - PointAt(of_nominal, slot)).norm());
    EXPECT_TRUE(PointAt(vehicle_points, slot).isApprox(nominal.vehicle_from_sensor * point, 1e-6));
    EXPECT_TRUE(PointAt(world_points, slot).isApprox(of_nominal.world_from_sensor * point, 1e-6));
  }
  EXPECT_GT(farthest_m, 0.05);
}

TEST(OutputAxes, WorldCoordinatesFarFromTheOriginAreRefused) {
  auto world = TurnedWorld();
  world->world_from_chunk.translation() = Vector3(6e5, 5.3e6, 400.0);
  SimulatorSpec spec = WithAxes(OutputFrame::kWorld, Handedness::kRight);
  const ScanPattern pattern = MakeRaster(40, 10, 1);
  EXPECT_EQ(MessageOf([&] { static_cast<void>(ScanOnce(world, pattern, spec)); }),
            "/output/origin_m: must lie within 8192 m of the sensor, since float32 loses "
            "millimetres beyond (got [0, 0, 0], sensor at [600000, 5300002, 403])");
  spec.output.origin_m = {6e5, 5.3e6, 400.0};
  const Frame frame = ScanOnce(world, pattern, spec);
  EXPECT_NEAR(static_cast<double>(frame.y[55]), 50.0, 1e-4);
}

// Beams that do not leave at the sensor's origin.

constexpr double kOut_m = 0.5;
constexpr double kUp_m = 0.25;

// One beam 10 deg beside the arm from whose end it leaves.
ScanPattern ArmPattern() {
  SpinningSpec spinning{.channels = {{.elevation_deg = 5.0, .azimuth_deg = 10.0, .time_us = 0.0}},
                        .cycle_us = 100.0,
                        .columns = 1000,
                        .beam_origin_m = {{kOut_m, kUp_m}}};
  return BuildScanPattern({.rate_hz = 10.0, .pattern = spinning});
}

TEST(BeamOrigin, OfATurningArmMovesRangesAndPoints) {
  // A wall across the forward direction.
  const auto world = WorldOfParts(
      {{{{{20, -60, -60}, {20, 60, -60}, {20, 60, 60}, {20, -60, 60}}, {{0, 1, 2}, {0, 2, 3}}},
        2,
        1}});
  const ScanPattern pattern = ArmPattern();
  const Frame frame = ScanOnce(world, pattern);
  int num_points = 0;
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const std::size_t slot = pattern.column[i];
    if (std::isnan(frame.x[slot])) continue;
    const double arm_rad = -2.0 * std::numbers::pi * pattern.column[i] / 1000.0;
    const Vector3 origin(kOut_m * std::cos(arm_rad), kOut_m * std::sin(arm_rad), kUp_m);
    const Vector3 direction = DirectionOf(pattern, i);
    const double range_m = (20.0 - origin.x()) / direction.x();
    const Vector3 point = origin + range_m * direction;
    // float32 resolves 100 m to 8 um.
    constexpr double kFloat_m = 5e-5;
    EXPECT_NEAR(static_cast<double>(frame.range_m[slot]), range_m, kFloat_m);
    EXPECT_NEAR(static_cast<double>(frame.x[slot]), point.x(), kFloat_m);
    EXPECT_NEAR(static_cast<double>(frame.y[slot]), point.y(), kFloat_m);
    EXPECT_NEAR(static_cast<double>(frame.z[slot]), point.z(), kFloat_m);
    ++num_points;
  }
  EXPECT_GT(num_points, 300);
}

TEST(BeamOrigin, BeyondAMetreIsRefused) {
  SpinningSpec spinning{.channels = {{}}, .cycle_us = 100.0, .columns = 10};
  spinning.beam_origin_m = {{0.0, 1.5}};
  EXPECT_EQ(MessageOf([&] {
              static_cast<void>(BuildScanPattern({.rate_hz = 10.0, .pattern = spinning}));
            }),
            "/pattern/beam_origin_m/1: must be >= -1 and <= 1 (got 1.5)");
}

constexpr std::uint32_t kDuration_ns = 99'583'333;

// A vehicle at 40 m/s, braking at 2 m/s^2 in a curve of 300 m radius, 60 m from the origin.
Transform BrakingInACurve(std::uint32_t time_ns) {
  const double t = time_ns * 1e-9;
  const double arc_m = 40.0 * t - t * t;
  const double heading_rad = arc_m / 300.0;
  return MakeTransform(
      RotationFromYawPitchRoll(heading_rad, 0.01, 0.05),
      {60.0 + 300.0 * std::sin(heading_rad), 300.0 * (1.0 - std::cos(heading_rad)), 2.5});
}

TEST(FramePoses, StayWithinATenthOfAMillimetreBetweenKnots) {
  const FramePoses poses(kDuration_ns, &BrakingInACurve);
  double worst_m = 0.0;
  double worst_rotation = 0.0;
  for (std::uint32_t time_ns = 0; time_ns <= kDuration_ns; time_ns += 333'333) {
    PoseF change{};
    const PoseF pose = poses.At(time_ns, change);
    const Transform truth = BrakingInACurve(time_ns);
    for (int i = 0; i < 3; ++i) {
      worst_m =
          std::max(worst_m, std::abs(static_cast<double>(pose.t[i]) - truth.translation()(i)));
      for (int j = 0; j < 3; ++j) {
        worst_rotation = std::max(worst_rotation, std::abs(static_cast<double>(pose.r[3 * i + j]) -
                                                           truth.linear()(i, j)));
      }
    }
  }
  // a dt^2 / 8 with a = v^2/R = 5.3 m/s^2 and dt = 10 ms is 0.067 mm, plus float32 rounding at 64
  // m.
  EXPECT_LE(worst_m, 1e-4);
  EXPECT_LE(worst_rotation, 4e-7);
}

TEST(FramePoses, SlopeIsTheVelocity) {
  const FramePoses poses(kDuration_ns, [](std::uint32_t time_ns) {
    return MakeTransform(Eigen::Matrix3d::Identity(), {20.0 * time_ns * 1e-9, 0.0, 0.0});
  });
  PoseF change{};
  const PoseF pose = poses.At(50'000'000, change);
  EXPECT_NEAR(static_cast<double>(pose.t[0]), 1.0, 1e-6);
  EXPECT_NEAR(static_cast<double>(change.t[0]) * 1e9, 20.0, 1e-3);
}

TEST(FramePoses, PatternsOfSecondsKeepTheirKnots) {
  constexpr std::uint32_t kLongest_ns = 4'290'000'000U;
  const FramePoses poses(kLongest_ns, [](std::uint32_t time_ns) {
    const double t = time_ns * 1e-9;
    return MakeTransform(Eigen::Matrix3d::Identity(), {t * t, 0.0, 0.0});
  });
  EXPECT_LE(poses.knot_spacing_ns(), 10'000'000U);
  PoseF change{};
  EXPECT_NEAR(static_cast<double>(poses.At(2'145'000'000U, change).t[0]), 2.145 * 2.145, 1e-4);
  EXPECT_NEAR(static_cast<double>(poses.At(kLongest_ns, change).t[0]), 4.29 * 4.29, 1e-4);
}

TEST(PosesBetween, AreAtMostTwentyMillisecondsApart) {
  struct Case {
    std::uint32_t duration_ns;
    std::size_t num;
  };
  for (const auto& [duration_ns, num] : {Case{0, 0}, Case{20'000'000, 0}, Case{20'000'001, 1},
                                         Case{kDuration_ns, 4}, Case{4'290'000'000U, 214}}) {
    const std::vector<ScanPose> poses = PosesBetween(duration_ns, [](std::uint32_t time_ns) {
      return MakeTransform(Eigen::Matrix3d::Identity(), {time_ns * 1e-9, 0.0, 0.0});
    });
    EXPECT_EQ(poses.size(), num) << duration_ns;
    std::uint32_t before_ns = 0;
    for (const ScanPose& pose : poses) {
      EXPECT_EQ(pose.world_from_sensor.translation().x(), pose.time_ns * 1e-9);
      EXPECT_GT(pose.time_ns, before_ns);
      EXPECT_LE(pose.time_ns - before_ns, 20'000'000U);
      before_ns = pose.time_ns;
    }
    EXPECT_LE(duration_ns - before_ns, 20'000'000U);
  }
}

TEST(FramePoses, AFlashHasOnePose) {
  const FramePoses poses(0, [](std::uint32_t) {
    return MakeTransform(Eigen::Matrix3d::Identity(), {1.0, 2.0, 3.0});
  });
  PoseF change{};
  EXPECT_EQ(poses.At(0, change).t[2], 3.0F);
}

}  // namespace
}  // namespace railcast
