#include "generator/extras/osi/sensor_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/units.h"
#include "tests/generator/extras/osi/example_view.h"

namespace railcast::osi {
namespace {

constexpr double kLight_mps = 299'792'458.0;
constexpr std::uint64_t kNobody = std::numeric_limits<std::uint64_t>::max();

TEST(SensorView, SaysWhatItIsAndWhen) {
  const auto view = ReadView(ExampleLidar(), EmptyFrame());
  EXPECT_EQ(view.version().version_major(), 3U);
  EXPECT_EQ(view.version().version_minor(), 8U);
  EXPECT_EQ(view.version().version_patch(), 0U);
  EXPECT_EQ(view.timestamp().seconds(), 2);
  EXPECT_EQ(view.timestamp().nanos(), 500'000'001U);
  EXPECT_EQ(view.sensor_id().value(), 0U);
  EXPECT_EQ(view.host_vehicle_id().value(), 7U);
  EXPECT_EQ(view.lidar_sensor_view(0).view_configuration().sensor_id().value(), 1U);
}

TEST(SensorView, SaysWhereTheSensorIs) {
  const LidarOfView lidar = ExampleLidar();
  const auto view = ReadView(lidar, EmptyFrame());
  const auto& mount = view.mounting_position();
  EXPECT_EQ(VectorOf(mount.position()), Vector3(12.4, 0.5, 2.5));
  EXPECT_TRUE(RotationOf(mount.orientation()).isApprox(lidar.rear_from_sensor.linear(), 1e-14));
  const auto& physical = view.lidar_sensor_view(0).view_configuration().mounting_position();
  EXPECT_EQ(physical.SerializeAsString(), mount.SerializeAsString());
}

TEST(SensorView, HasRaysFromTheLeftToTheRightAndFromTheTopDown) {
  const auto configuration =
      ReadView(ExampleLidar(), EmptyFrame()).lidar_sensor_view(0).view_configuration();
  EXPECT_EQ(configuration.number_of_rays_horizontal(), 4U);
  EXPECT_EQ(configuration.number_of_rays_vertical(), 3U);
  EXPECT_EQ(configuration.num_of_pixels(), 12U);
  ASSERT_EQ(configuration.directions_size(), 12);
  ASSERT_EQ(configuration.timings_size(), 12);
  for (int i = 0; i < 12; ++i) {
    const Vector3 direction = VectorOf(configuration.directions(i));
    const double azimuth_deg = DegFromRad(std::atan2(direction.y(), direction.x()));
    const double elevation_deg = DegFromRad(std::asin(direction.z()));
    EXPECT_NEAR(azimuth_deg, 15.0 - 10.0 * (i % 4), 1e-5) << i;
    EXPECT_NEAR(elevation_deg, 10.0 - 10.0 * (i / 4), 1e-5) << i;
    // A column every quarter of 0.1 s.
    EXPECT_EQ(configuration.timings(i), 25'000U * static_cast<unsigned>(i % 4)) << i;
  }
  // As far to either side as the outermost rays.
  EXPECT_NEAR(configuration.field_of_view_horizontal(), RadFromDeg(30.0), 1e-6);
  EXPECT_NEAR(configuration.field_of_view_vertical(), RadFromDeg(20.0), 1e-6);
  EXPECT_NEAR(configuration.emitter_frequency(), kLight_mps / 905e-9, 1.0);
}

TEST(SensorView, BeginsAtTheLeftEndWhereverTheRotorDoes) {
  SpinningSpec spinning{.channels = {{.elevation_deg = 0.0, .azimuth_deg = 0.0, .time_us = 0.0}},
                        .cycle_us = 10'000.0,
                        .columns = 10};
  for (const Rotation rotation : {Rotation::kClockwise, Rotation::kCounterclockwise}) {
    spinning.rotation = rotation;
    const ScanPattern pattern = BuildScanPattern({.rate_hz = 10.0, .pattern = spinning});
    double last_rad = std::numbers::pi + 1e-6;
    for (const std::uint32_t firing : FiringsByRay(pattern)) {
      const double azimuth_rad =
          std::atan2(pattern.direction_y[firing], pattern.direction_x[firing]);
      EXPECT_LT(azimuth_rad, last_rad);
      last_rad = azimuth_rad;
    }
  }
}

TEST(SensorView, GivesBackEveryPoint) {
  Frame frame = EmptyFrame();
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    PutPoint(i, 1.0F + 17.0F * static_cast<float>(i), 0, frame);
  }
  const auto view = ReadView(ExampleLidar(), frame);
  const auto& lidar = view.lidar_sensor_view(0);
  ASSERT_EQ(lidar.reflection_size(), 12);
  for (int i = 0; i < 12; ++i) {
    // The top row of the raster is the frame's last.
    const std::size_t slot =
        static_cast<std::size_t>(2 - i / 4) * 4 + static_cast<std::size_t>(i % 4);
    const double range_m = 0.5 * kLight_mps * lidar.reflection(i).time_of_flight();
    EXPECT_DOUBLE_EQ(range_m, static_cast<double>(frame.range_m[slot])) << i;
    EXPECT_NEAR(VectorOf(lidar.view_configuration().directions(i)).norm(), 1.0, 1e-7);
  }
}

TEST(SensorView, KeepsRaysWithoutAReturn) {
  Frame frame = EmptyFrame();
  PutPoint(5, 30.0F, 0, frame);
  frame.outcome[6] = Outcome::kBelowThreshold;
  frame.power_ratio[6] = 0.5F;
  const auto lidar = ReadView(ExampleLidar(), frame).lidar_sensor_view(0);
  ASSERT_EQ(lidar.reflection_size(), 12);
  for (int i = 0; i < 12; ++i) {
    EXPECT_EQ(lidar.reflection(i).has_time_of_flight(), i == 5) << i;
    EXPECT_EQ(lidar.reflection(i).ByteSizeLong() > 0, i == 5) << i;
  }
}

TEST(SensorView, HasARayForEachReturnOfAFiring) {
  Frame frame = EmptyFrame(2);
  PutPoint(2, 30.0F, 0, frame);
  PutPoint(3, 60.0F, 0, frame);
  const auto lidar = ReadView(ExampleLidar(), frame).lidar_sensor_view(0);
  const auto& configuration = lidar.view_configuration();
  EXPECT_EQ(configuration.number_of_rays_horizontal(), 8U);
  EXPECT_EQ(configuration.directions_size(), 24);
  ASSERT_EQ(lidar.reflection_size(), 24);
  // The second firing of the lowest row.
  EXPECT_DOUBLE_EQ(lidar.reflection(18).time_of_flight(), 60.0 / kLight_mps);
  EXPECT_DOUBLE_EQ(lidar.reflection(19).time_of_flight(), 120.0 / kLight_mps);
  EXPECT_EQ(configuration.directions(18).SerializeAsString(),
            configuration.directions(19).SerializeAsString());
}

TEST(SensorView, HasThePowerOverTheEmittedOneInDecibels) {
  Frame frame = EmptyFrame();
  PutPoint(8, 30.0F, 0, frame);
  PutPoint(9, 30.0F, 0, frame);
  frame.power_ratio[8] = 100.0F;
  frame.power_ratio[9] = std::numeric_limits<float>::quiet_NaN();
  const auto lidar = ReadView(ExampleLidar(), frame).lidar_sensor_view(0);
  EXPECT_DOUBLE_EQ(lidar.reflection(0).signal_strength(), -80.0);
  EXPECT_FALSE(lidar.reflection(1).has_signal_strength());
  EXPECT_TRUE(lidar.reflection(1).has_time_of_flight());
}

TEST(SensorView, HasTheDopplerShiftOfVelocitiesAlongTheBeams) {
  Frame frame = EmptyFrame();
  EXPECT_FALSE(
      ReadView(ExampleLidar(), frame).lidar_sensor_view(0).reflection(0).has_doppler_shift());
  frame.has_velocity = true;
  frame.Resize(frame.rows, frame.columns, 1);
  PutPoint(8, 30.0F, 0, frame);
  PutPoint(9, 30.0F, 0, frame);
  frame.radial_velocity_mps[8] = -20.0F;
  frame.radial_velocity_mps[9] = std::numeric_limits<float>::quiet_NaN();
  LidarOfView lidar = ExampleLidar();
  lidar.wavelength_nm = 1550;
  const auto view = ReadView(lidar, frame).lidar_sensor_view(0);
  // What comes nearer returns at a higher frequency.
  EXPECT_NEAR(view.reflection(0).doppler_shift(), 2.0 * 20.0 / 1550e-9, 1.0);
  EXPECT_FALSE(view.reflection(1).has_doppler_shift());
}

TEST(SensorView, NamesTheObjectsThatTheTruthHolds) {
  Frame frame = EmptyFrame();
  PutPoint(8, 30.0F, 12, frame);
  PutPoint(9, 30.0F, 99, frame);  // A mast, which has no box.
  PutPoint(10, 30.0F, 0, frame);
  PutPoint(11, 30.0F, 12, frame);
  frame.outcome[11] = Outcome::kClutter;  // Its mirror image.
  const auto view =
      ReadView(ExampleLidar(), frame, {ExampleObject(7, "ego"), ExampleObject(12, "person")});
  const auto& lidar = view.lidar_sensor_view(0);
  EXPECT_EQ(lidar.reflection(0).object_id().value(), 12U);
  for (const int i : {1, 2, 3}) EXPECT_EQ(lidar.reflection(i).object_id().value(), kNobody) << i;
}

TEST(SensorView, HasTheSameBytesForTheSameFrame) {
  Frame frame = EmptyFrame();
  PutPoint(3, 30.0F, 7, frame);
  const std::vector<ObjectOfView> objects = {ExampleObject(7, "ego"), ExampleObject(8, "person")};
  const WeatherSpec weather;
  EXPECT_EQ(SensorViewOf(ExampleLidar(), {frame, objects, weather}),
            SensorViewOf(ExampleLidar(), {frame, objects, weather}));
}

}  // namespace
}  // namespace railcast::osi
