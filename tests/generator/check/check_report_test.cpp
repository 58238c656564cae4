#include "generator/check/check_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "railcast/scenario.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

ScanPattern FourFirings() {
  return BuildScanPattern({10.0, RasterSpec{40.0, 10.0, 10.0, RasterOrder::kColumns}});
}

AlignmentSpec CurveAfterAStraight() {
  AlignmentSpec spec;
  spec.course = AlignmentElementsSpec{
      {{ElementType::kStraight, 300.0, {}}, {ElementType::kArc, 200.0, -500.0}}};
  spec.gradients_permil = {{0.0, 0.0}, {100.0, 2.0}, {200.0, -6.0}};
  return spec;
}

TEST(CheckReport, StatesTheSensorsRates) {
  LidarSpec lidar;
  lidar.name = "odd";
  EXPECT_EQ(SensorText(lidar, FourFirings()),
            "sensor    odd: 4 firings a frame (1 rows x 4 columns), range 0.5 to 300 m\n"
            "          10 frames/s, each fired within 0.075 s; at most 40 points/s\n");
}

TEST(CheckReport, StatesTheScanOfATable) {
  LidarSpec lidar;
  lidar.scan.pattern = FiringTableSpec{};
  const auto scan_of = [&](double width_deg, std::uint32_t step_ns) {
    ScanPattern pattern = FourFirings();
    for (std::size_t i = 0; i < 4; ++i) {
      const double azimuth_rad =
          width_deg * std::numbers::pi / 180.0 * static_cast<double>(i) / 3.0;
      pattern.direction_x[i] = static_cast<float>(std::cos(azimuth_rad));
      pattern.direction_y[i] = static_cast<float>(std::sin(azimuth_rad));
      pattern.direction_z[i] = 0.0F;
      pattern.time_ns[i] = static_cast<std::uint32_t>(i) * step_ns;
    }
    const std::string text = SensorText(lidar, pattern);
    return text.substr(text.find("a table"));
  };
  EXPECT_EQ(scan_of(30.0, 1000), "a table: 1e+06 firings/s, a field of view of 30 x 0 degrees\n");
  EXPECT_EQ(scan_of(30.0, 1),
            "a table: 1e+09 firings/s, a field of view of 30 x 0 degrees\n"
            "          remark: no sensor fires so fast: is time_us in microseconds?\n");
  EXPECT_EQ(scan_of(1.5, 0),
            "a table: all at once, a field of view of 1.5 x 0 degrees\n"
            "          remark: no sensor looks so narrowly: are the angles in degrees?\n");
}

TEST(CheckReport, SaysThatFramesDiffer) {
  LidarSpec lidar;
  lidar.name = "loops";
  const ScanPattern pattern = BuildScanPattern(
      {.rate_hz = 10.0,
       .pattern = RisleySpec{.channels = {ChannelSpec{}},
                             .cycle_us = 100.0,
                             .columns = 1000,
                             .prisms = {{.refractive_index = 1.5, .turns_hz = 7.0}}}});
  EXPECT_THAT(SensorText(lidar, pattern),
              testing::EndsWith("10000 points/s\n"
                                "          a figure that goes on from frame to frame\n"));
}

TEST(CheckReport, SaysWhatACameraIs) {
  CameraSpec camera{.width_px = 640, .height_px = 480, .horizontal_fov_deg = 62.5};
  EXPECT_EQ(CameraText(camera),
            "camera    camera: 640 x 480 pixels, 62.5 degrees wide, an image with each frame\n");
  camera.name = "front";
  camera.rate_hz = 2.5;
  EXPECT_EQ(CameraText(camera),
            "camera    front: 640 x 480 pixels, 62.5 degrees wide, 2.5 images/s\n");
}

TEST(CheckReport, ListsMotionSensors) {
  MotionSensorsSpec spec;
  EXPECT_EQ(MotionSensorsText(spec), "");
  spec.imus.emplace_back().rate_hz = 200.0;
  spec.gnss.emplace_back().name = "rear";
  spec.odometers.emplace_back();
  EXPECT_EQ(MotionSensorsText(spec),
            "motion    imu: IMU, 200 samples/s\n"
            "          rear: GNSS receiver, 1 samples/s\n"
            "          odometer: odometer, 50 samples/s\n");
}

TEST(CheckReport, CallsALineStraight) {
  AlignmentSpec spec;
  spec.course = AlignmentElementsSpec{{{ElementType::kStraight, 300.0, {}}}};
  EXPECT_EQ(LineText(Alignment(spec), 1435.0, false), "line      300.0 m, straight\n");
}

TEST(CheckReport, RemarksOnCurvesOfWhichNoNormHasTheClearSpace) {
  const auto remark_at = [](double radius_m) {
    AlignmentSpec spec;
    spec.course = AlignmentElementsSpec{{{ElementType::kArc, 100.0, radius_m}}};
    const std::string text = LineText(Alignment(spec), 1435.0, false);
    return text.substr(text.find('\n') + 1);
  };
  EXPECT_EQ(
      remark_at(-99.0),
      "          remark: norms have no clear space of curves of less than 100 m; what stands in "
      "it is a guess\n");
  EXPECT_EQ(remark_at(101.0), "");
}

TEST(CheckReport, ListsSmoothedJumpsOnlyIfAskedTo) {
  const Alignment alignment(CurveAfterAStraight());
  const std::string summary =
      "line      500.0 m, tightest radius 500.0 m\n"
      "          1 curvature jump smoothed, the largest of 0.002 1/m at s 300.0 m\n"
      "          2 gradient steps smoothed, the largest of 8 permil at s 200.0 m\n";
  EXPECT_EQ(LineText(alignment, 1435.0, false), summary + "          (-v lists them)\n");
  EXPECT_EQ(LineText(alignment, 1435.0, true),
            summary +
                "            curvature at s 300 m: from 0 to -0.002 1/m over 20 m\n"
                "            gradient at s 100 m: from 0 to 2 permil over 40 m\n"
                "            gradient at s 200 m: from 2 to -6 permil over 40 m\n");
}

TEST(CheckReport, SaysWhereTheVehiclesWayEnds) {
  const VehicleWay way{{0.0, 200.0, 8.0}, WayPoint{13.75, 255.0, 0.0}, std::nullopt};
  EXPECT_EQ(VehicleText("main", way, {.rate_hz = 10.0, .pattern = {}}),
            "vehicle   starts on track \"main\" at s 200.00 m with 8 m/s\n"
            "          reaches the end of its speed profile after 13.75 s (frame 137), at s 255.00 "
            "m, and stands\n"
            "          never reaches the end of its track\n");
}

TEST(CheckReport, NamesTheFrameThatAMomentFallsOn) {
  const WayPoint start{0.0, 400.0, 10.0};
  const VehicleWay way{start, start, WayPoint{60.0 - 1e-10, 1000.0, 10.0}};
  EXPECT_EQ(VehicleText("main", way, {.rate_hz = 10.0, .pattern = {}}),
            "vehicle   starts on track \"main\" at s 400.00 m with 10 m/s\n"
            "          reaches the end of its track after 60.00 s (frame 600), at s 1000.00 m\n");
}

TEST(CheckReport, CountsFramesFromThePhaseOfTheSensor) {
  const VehicleWay way{{0.0, 200.0, 8.0}, WayPoint{0.02, 255.0, 0.0}, WayPoint{1.04, 300.0, 8.0}};
  EXPECT_EQ(VehicleText("main", way, {.rate_hz = 10.0, .pattern = {}, .phase_s = 0.05}),
            "vehicle   starts on track \"main\" at s 200.00 m with 8 m/s\n"
            "          reaches the end of its speed profile after 0.02 s (frame 0), at s 255.00 m, "
            "and stands\n"
            "          reaches the end of its track after 1.04 s (frame 9), at s 300.00 m\n");
}

TEST(CheckReport, RemarksThatAMovingVehicleHasNoRide) {
  VehicleSpec vehicle;
  vehicle.motion.profile = {{0.0, {}, 0.0}};
  EXPECT_EQ(RideText(vehicle), "") << "it stands";
  vehicle.motion.profile.push_back({9.0, {}, 5.0});
  EXPECT_EQ(RideText(vehicle),
            "          remark: it has no ride (vehicle.ride): neither track nor brakes shake it\n");
  vehicle.ride = RideSpec{};
  EXPECT_EQ(RideText(vehicle), "");
  vehicle.ride.reset();
  vehicle.pivot_distance_m = 0.0;
  EXPECT_EQ(RideText(vehicle), "") << "the sensor is on a bogie";
  vehicle.consist.emplace_back().type = ObjectType("multiple_unit");
  EXPECT_NE(RideText(vehicle), "") << "a train's vehicles have their own pivots";
}

TEST(CheckReport, WarnsOfCoarseWorldCoordinates) {
  const Vector3 far_m(5.3e6, 6e5, 400.0);
  EXPECT_EQ(OutputText({OutputFrame::kSensor, Handedness::kRight, {0, 0, 0}}, far_m), "");
  EXPECT_EQ(OutputText({OutputFrame::kWorld, Handedness::kRight, {0, 0, 0}}, far_m),
            "output    world coordinates: float32 has steps of 500 mm where the sensor starts; put "
            "output.origin_m near there\n");
  EXPECT_EQ(OutputText({OutputFrame::kWorld, Handedness::kRight, {5.3e6, 6e5, 0}}, far_m),
            "output    world coordinates: float32 has steps of 0.03052 mm where the sensor "
            "starts\n");
}

TEST(CheckReport, SaysWhatIsAroundTheSensor) {
  SimpleWorld world;
  world.AddObject(std::make_shared<const Model>(), Transform::Identity());
  SensorSurroundings around{
      Vector3(1, 2, 3), SightedSurface{0.5, 9, 1}, SightedSurface{2.0, 7, 0}, {}, 0};
  const LabelTable labels({{7, "ballast", {}, "", "", 0, 0}, {9, "wagon", {}, "", "", 0, 0}});
  EXPECT_EQ(SurroundingsText(around, world, labels),
            "around    at frame 0 the sensor is at world 1.00 2.00 3.00 m\n"
            "          below it: ballast, 2.00 m\n"
            "          above it: nothing\n"
            "          nearest: wagon of \"object1\", 0.50 m\n");
  around.inside = 1;
  EXPECT_NE(SurroundingsText(around, world, labels).find("INSIDE"), std::string::npos);
}

TEST(CheckReport, NamesObjectsThatTouchOrOverlap) {
  SimpleWorld world;
  for (int i = 0; i < 3; ++i) {
    world.AddObject(std::make_shared<const Model>(), Transform::Identity());
  }
  EXPECT_EQ(
      ContactsText(
          {{0, 9, 0, {0, 2, 0.0049}}, {4, 4, 4, {0, 1, -0.02}}, {5, 7, 6, {1, 2, -0.1234}}}, world,
          9),
      "contacts  in frames 0 to 9:\n"
      "          \"object1\" touches \"object3\" in frames 0 to 9: 0.005 m apart at frame 0\n"
      "          \"object1\" touches \"object2\" in frame 4: 0.020 m deep at frame 4\n"
      "          \"object2\" overlaps \"object3\" in frames 5 to 7: 0.123 m deep at frame 6\n");
  EXPECT_EQ(ContactsText({}, world, 9), "contacts  none in frames 0 to 9\n");
}

}  // namespace
}  // namespace railcast
