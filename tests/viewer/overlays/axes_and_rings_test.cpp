#include "viewer/overlays/overlays.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "railcast/scenario.h"

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

}  // namespace
}  // namespace railcast
