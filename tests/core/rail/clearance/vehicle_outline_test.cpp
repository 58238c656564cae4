#include "core/rail/clearance/clear_space.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/base/units.h"

namespace railcast {
namespace {

TEST(VehicleOutline, TakesThePantographsWidthFromTabelle1) {
  EXPECT_EQ(PantographHalfWidth_m(5.3), 1.43);
  EXPECT_EQ(PantographHalfWidth_m(5.5), 1.44);
  EXPECT_EQ(PantographHalfWidth_m(5.51), 1.47);
  EXPECT_EQ(PantographHalfWidth_m(5.9), 1.47);
  EXPECT_EQ(PantographHalfWidth_m(6.5), 1.51);
  EXPECT_EQ(PantographHalfWidth_m(6.51), std::nullopt);
}

TEST(VehicleOutline, IsThatOfWagonsWithThePantographsAboveIt) {
  const auto sizes = [](std::optional<double> contact_height_m) {
    std::vector<std::array<double, 3>> parts;
    for (const GaugePart& part : VehicleOutline(contact_height_m)) {
      parts.push_back({part.half_width_m, part.bottom_m, part.top_m});
    }
    return parts;
  };
  using Size = std::array<double, 3>;
  EXPECT_THAT(sizes(5.3), testing::ElementsAre(Size{1.575, 0.0, 4.28}, Size{1.43, 4.28, 5.2}));
  EXPECT_THAT(sizes(std::nullopt), testing::ElementsAre(Size{1.575, 0.0, 4.28}));
}

/// A box of 2 m x 1 m x 1.8 m standing at top of rail + `h_m`, with its centre `d_m` from the axis.
GaugeClearance StandingClearance(double d_m, double heading_deg = 0.0, double h_m = 0.0) {
  const Vector3 size_m(2.0, 1.0, 1.8);
  Transform track_from_box = Transform::Identity();
  track_from_box.translate(Vector3(40.0, d_m, h_m + 0.9));
  track_from_box.rotate(Eigen::AngleAxisd(RadFromDeg(heading_deg), Vector3::UnitZ()));
  return ClearanceOf(VehicleOutline(5.5), track_from_box, size_m);
}

TEST(VehicleOutline, HoldsWhatReachesOverItsEdge) {
  EXPECT_TRUE(StandingClearance(0.0).is_inside);
  EXPECT_EQ(StandingClearance(0.0).from_axis_m, 0.0);
  for (const double side : {-1.0, 1.0}) {
    EXPECT_TRUE(StandingClearance(side * 2.074).is_inside);
    EXPECT_FALSE(StandingClearance(side * 2.076).is_inside);
    EXPECT_NEAR(StandingClearance(side * 2.4).from_axis_m, 1.9, 1e-12);
  }
  // When it is rotated, a corner is nearest to the axis: sqrt(5) / 2 from the centre at atan(1 /
  // 2).
  const double heading_deg = DegFromRad(std::atan(2.0));
  const double reach_m = std::sqrt(5.0) / 2.0;
  const double corner_deg = 90.0 - DegFromRad(std::atan(0.5));
  EXPECT_NEAR(corner_deg, heading_deg, 1e-9);
  EXPECT_TRUE(StandingClearance(1.574 + reach_m, heading_deg).is_inside);
  EXPECT_FALSE(StandingClearance(1.576 + reach_m, heading_deg).is_inside);
}

TEST(VehicleOutline, LeavesOutWhatIsBelowTheRailsAndAboveTrains) {
  EXPECT_TRUE(StandingClearance(0.0, 0.0, -1.799).is_inside);
  EXPECT_FALSE(StandingClearance(0.0, 0.0, -1.801).is_inside);
  EXPECT_TRUE(StandingClearance(0.0, 0.0, 5.199).is_inside);
  EXPECT_FALSE(StandingClearance(0.0, 0.0, 5.201).is_inside);
  // Above the wagons, but beside the space for pantographs.
  EXPECT_FALSE(StandingClearance(1.95, 0.0, 4.3).is_inside);
  EXPECT_TRUE(StandingClearance(1.93, 0.0, 4.3).is_inside);
  EXPECT_TRUE(StandingClearance(1.95, 0.0, 4.2).is_inside);
}

// A beam leaning over the track: both its bounding intervals overlap the gauge, but the beam does
// not.
TEST(VehicleOutline, LetsPassWhatLeansPastItsCorner) {
  Transform track_from_box = Transform::Identity();
  track_from_box.translate(Vector3(0.0, 2.6, 4.0));
  track_from_box.rotate(Eigen::AngleAxisd(RadFromDeg(45.0), Vector3::UnitX()));
  // Its axis passes through (2.6, 4.0), to the upper right of the corner (1.575, 4.28).
  const Vector3 thin(0.2, 0.2, 8.0);
  const double from_corner_m = std::abs((2.6 - 1.575) + (4.0 - 4.28)) / std::sqrt(2.0);
  ASSERT_GT(from_corner_m, 0.11);
  EXPECT_FALSE(ClearanceOf(VehicleOutline(std::nullopt), track_from_box, thin).is_inside);
  const Vector3 thick(0.2, 2.0 * from_corner_m + 0.01, 8.0);
  EXPECT_TRUE(ClearanceOf(VehicleOutline(std::nullopt), track_from_box, thick).is_inside);
}

}  // namespace
}  // namespace railcast
