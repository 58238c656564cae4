#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "railcast/scenario.h"
#include "tests/support/scan_once.h"
#include "tests/support/sensor_file.h"
#include "viewer/overlays/overlays.h"

namespace railcast {
namespace {

std::vector<std::string> Texts(const Overlay& drawing) {
  std::vector<std::string> texts;
  for (const Overlay::Word& word : drawing.words) texts.push_back(word.text);
  return texts;
}

TEST(Axes, AreTwoMetresLongAndNamed) {
  const Overlay drawing = DrawAxes();
  ASSERT_EQ(drawing.segments.size(), 3U);
  EXPECT_EQ(drawing.segments[1].to_m, Eigen::Vector3f(0.0F, 2.0F, 0.0F));
  EXPECT_THAT(Texts(drawing), testing::ElementsAre("x", "y", "z"));
  EXPECT_EQ(drawing.words[2].at_m, Eigen::Vector3f(0.0F, 0.0F, 2.0F));
}

TEST(RangeRings, StayWithinACentimetreOfTheirCircles) {
  const Overlay drawing = DrawRangeRings(300.0, std::nullopt);
  const std::array<double, 7> radii_m = {10.0, 25.0, 50.0, 100.0, 150.0, 200.0, 300.0};
  const auto is_near_a_circle = [&](const Eigen::Vector3f& place_m, double within_m) {
    return std::ranges::any_of(radii_m, [&](double radius_m) {
      return std::abs(place_m.cast<double>().norm() - radius_m) <= within_m;
    });
  };
  for (const Overlay::Segment& segment : drawing.segments) {
    EXPECT_TRUE(is_near_a_circle(segment.from_m, 1e-4));  // Rounding of float32 at 300 m is 3e-5.
    EXPECT_TRUE(is_near_a_circle(0.5F * (segment.from_m + segment.to_m), 0.01 + 1e-4));
    EXPECT_EQ(segment.from_m.z(), 0.0F);
  }
}

TEST(RangeRings, Close) {
  const Overlay drawing = DrawRangeRings(10.0, std::nullopt);
  for (std::size_t i = 0; i < drawing.segments.size(); ++i) {
    EXPECT_EQ(drawing.segments[i].to_m, drawing.segments[(i + 1) % drawing.segments.size()].from_m);
  }
}

TEST(RangeRings, StopAtTheLimitAndSayTheirRadiusAheadAndBehind) {
  const Overlay drawing = DrawRangeRings(50.0, std::nullopt);
  EXPECT_THAT(Texts(drawing), testing::ElementsAre("10 m", "10 m", "25 m", "25 m", "50 m", "50 m"));
  EXPECT_EQ(drawing.words[4].at_m, Eigen::Vector3f(50.0F, 0.0F, 0.0F));
  EXPECT_EQ(drawing.words[5].at_m, Eigen::Vector3f(-50.0F, 0.0F, 0.0F));
}

TEST(RangeRings, LieAtTopOfRailBelowASensorWhoseMountIsKnown) {
  MountSpec mount{.position_m = {2.2, 0.3, 2.5}, .pitch_deg = 5.0};
  mount.yaw_deg = 30.0;
  const Overlay drawing = DrawRangeRings(25.0, mount);
  const Transform vehicle_from_sensor = VehicleFromSensor(mount);
  for (const Overlay::Segment& segment : drawing.segments) {
    const Vector3 place = vehicle_from_sensor * segment.from_m.cast<double>();
    EXPECT_NEAR(place.z(), 0.0, 1e-5);
    const double radius_m = std::hypot(place.x() - 2.2, place.y() - 0.3);
    EXPECT_LT(std::min(std::abs(radius_m - 10.0), std::abs(radius_m - 25.0)), 1e-5);
  }
  const Vector3 ahead = vehicle_from_sensor * drawing.words[0].at_m.cast<double>();
  EXPECT_LT((ahead - Vector3(12.2, 0.3, 0.0)).norm(), 1e-5);
}

// The directions are float32: 1e-7 rad.
constexpr double kAngle_deg = 1e-4;

Overlay DrawFrustum(const ScanPattern& pattern, double range_m) {
  return DrawSensorFrustum(MakeScanTable(pattern).value(), range_m);
}

std::vector<Vector3> RayEnds(const Overlay& drawing) {
  std::vector<Vector3> ends;
  for (const Overlay::Segment& segment : drawing.segments) {
    if (segment.from_m.isZero(0.0F)) ends.emplace_back(segment.to_m.cast<double>());
  }
  return ends;
}

double Elevation_deg(const Vector3& place_m) {
  return DegFromRad(std::asin(place_m.z() / place_m.norm()));
}

TEST(SensorFrustum, HasTheCornersOfAPartTurn) {
  // Beams go through the middles of cells of 0.25 deg.
  const std::vector<Vector3> ends = RayEnds(DrawFrustum(MakeRaster(60.0, 30.0, 0.25), 80.0));
  ASSERT_EQ(ends.size(), 4U);
  for (const double elevation_deg : {-14.875, 14.875}) {
    for (const double azimuth_deg : {-29.875, 29.875}) {
      EXPECT_TRUE(std::ranges::any_of(
          ends,
          [&](const Vector3& end) {
            return std::abs(Elevation_deg(end) - elevation_deg) < kAngle_deg &&
                   std::abs(DegFromRad(std::atan2(end.y(), end.x())) - azimuth_deg) < kAngle_deg &&
                   std::abs(end.norm() - 80.0) < 1e-4;
          }))
          << elevation_deg << " " << azimuth_deg;
    }
  }
}

TEST(SensorFrustum, RunsFromBeamToBeamAlongItsBorder) {
  const Overlay drawing = DrawFrustum(MakeRaster(60.0, 30.0, 0.25), 80.0);
  EXPECT_EQ(drawing.segments.size(), 4U + 2U * 239U + 2U * 119U);
}

TEST(SensorFrustum, HasTwoConesOfFifteenDegreesForAVlp16) {
  const ScanPattern pattern = BuildScanPattern(ReadSensor("vlp16"));
  const Overlay drawing = DrawFrustum(pattern, 50.0);
  ASSERT_EQ(drawing.segments.size(), 2U * (8U + pattern.columns));
  EXPECT_EQ(RayEnds(drawing).size(), 16U);
  int num_up = 0;
  for (const Overlay::Segment& segment : drawing.segments) {
    const Vector3 end = segment.to_m.cast<double>();
    EXPECT_NEAR(std::abs(Elevation_deg(end)), 15.0, kAngle_deg);
    EXPECT_NEAR(end.norm(), 50.0, 1e-4);
    num_up += end.z() > 0.0 ? 1 : 0;
  }
  EXPECT_EQ(num_up * 2, static_cast<int>(drawing.segments.size()));
}

TEST(SensorFrustum, SpreadsTheRaysOfATurnEvenly) {
  const std::vector<Vector3> ends =
      RayEnds(DrawFrustum(BuildScanPattern(ReadSensor("vlp16")), 50.0));
  for (std::size_t i = 0; i + 1 < 8; ++i) {
    const double angle_deg = DegFromRad(
        std::acos(ends[i].head<2>().normalized().dot(ends[i + 1].head<2>().normalized())));
    EXPECT_NEAR(angle_deg, 45.0, 0.2);  // Tolerance: the step of a column.
  }
}

TEST(SensorFrustum, TakesTheOutermostRowsAndColumnsThatAreKnown) {
  ScanTable table = MakeScanTable(MakeRaster(60.0, 30.0, 0.25)).value();
  table.elevation_rad.back() = std::nan("");
  table.column_azimuth_rad.front() = std::nan("");
  const Overlay drawing = DrawSensorFrustum(table, 80.0);
  EXPECT_EQ(drawing.segments.size(), 4U + 2U * 238U + 2U * 118U);
  double highest_deg = -90.0;
  for (const Vector3& end : RayEnds(drawing)) {
    highest_deg = std::max(highest_deg, Elevation_deg(end));
    EXPECT_TRUE(end.allFinite());
  }
  EXPECT_NEAR(highest_deg, 14.625, kAngle_deg);
}

TEST(SensorFrustum, EndsAtAHundredMetres) {
  for (const Vector3& end : RayEnds(DrawFrustum(MakeRaster(60.0, 30.0, 0.25), 300.0))) {
    EXPECT_NEAR(end.norm(), 100.0, 1e-4);
  }
}

}  // namespace
}  // namespace railcast
