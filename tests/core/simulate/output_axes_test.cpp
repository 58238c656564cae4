#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

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

}  // namespace
}  // namespace railcast
