#include "core/rail/clearance/clear_space.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/base/units.h"

namespace railcast {
namespace {

constexpr double kRounding = 1e-12;

TEST(ClearSpace, AddsUpAsTheRegulationSays) {
  // Height and half width of the reference line G2 (EBO Anlage 8), and random displacement (Anlage
  // 2, 2.3); 5 mm for the track gauge (2.1.1).
  struct Sum {
    double height_m;
    double reference_m;
    double random_m;
  };
  constexpr std::array<Sum, 8> kSums = {{{0.13, 1.25, 0.031},
                                         {0.4, 1.52, 0.031},
                                         {0.4, 1.62, 0.031},
                                         {1.17, 1.62, 0.040},
                                         {1.17, 1.645, 0.040},
                                         {3.53, 1.645, 0.104},
                                         {3.835, 1.47, 0.114},
                                         {4.68, 0.785, 0.140}}};
  const std::vector<HalfWidth> rows = ClearSpace(ClearHalfWidths({}), std::nullopt, {}, 1.0);
  ASSERT_EQ(rows.size(), kSums.size() + 3);
  for (std::size_t i = 0; i < kSums.size(); ++i) {
    const Sum& sum = kSums[i];
    // Rails wear by 10 mm, and tracks are lifted by 50 mm.
    const double moved_m = sum.height_m > 2.0 ? 0.05 : -0.01;
    EXPECT_NEAR(rows[i + 3].height_m, sum.height_m + moved_m, kRounding) << i;
    EXPECT_NEAR(rows[i + 3].half_width_m, sum.reference_m + 0.005 + sum.random_m, kRounding) << i;
  }
}

TEST(ClearSpace, IsWiderInCurvesByTheStandardsFormulas) {
  EXPECT_EQ(CurveWidening_m(0.0, 1.0), 0.0);
  EXPECT_NEAR(CurveWidening_m(1.0 / 300.0, 1.0), 0.0125, 1e-12);
  EXPECT_NEAR(CurveWidening_m(-1.0 / 300.0, 1.0), 0.0125, 1e-12);
  // Inside and outside agree at 250 m.
  for (const double side : {-1.0, 1.0}) {
    EXPECT_NEAR(CurveWidening_m(1.0 / 250.0, side), 0.015, 1e-12);
    EXPECT_NEAR(CurveWidening_m(1.0 / 249.999, side), 0.015, 1e-6);
  }
  EXPECT_NEAR(CurveWidening_m(1.0 / 200.0, 1.0), 0.065, 1e-12);
  EXPECT_NEAR(CurveWidening_m(1.0 / 200.0, -1.0), 0.075, 1e-12);
  EXPECT_NEAR(CurveWidening_m(-1.0 / 200.0, -1.0), 0.065, 1e-12);
  // Where they end, the table of the EBO goes on, which adds to what is there at 250 m.
  EXPECT_NEAR(CurveWidening_m(1.0 / 150.0, 1.0), 50.0 / 150.0 - 0.185, 1e-12);
  EXPECT_NEAR(CurveWidening_m(1.0 / 149.999, 1.0), 50.0 / 150.0 - 0.185, 1e-5);
  EXPECT_NEAR(CurveWidening_m(1.0 / 149.999, -1.0), 60.0 / 150.0 - 0.225, 1e-5);
  EXPECT_NEAR(CurveWidening_m(1.0 / 120.0, 1.0), 0.35, 1e-12);
  EXPECT_NEAR(CurveWidening_m(-1.0 / 120.0, 1.0), 0.38, 1e-12);
  EXPECT_NEAR(CurveWidening_m(1.0 / 110.0, 1.0), 0.5 * (0.35 + 0.545), 1e-12);
  EXPECT_NEAR(CurveWidening_m(1.0 / 100.0, -1.0), 0.585, 1e-12);
  EXPECT_NEAR(CurveWidening_m(1.0 / 50.0, 1.0), 2.0 * 0.545, 1e-12) << "beyond any figure";
  const std::vector<HalfWidth> outside =
      ClearSpace(ClearHalfWidths({}), std::nullopt, {1.0 / 200.0, 0.0}, -1.0);
  for (std::size_t i = 0; i < outside.size(); ++i) {
    EXPECT_NEAR(outside[i].half_width_m, kClearHalfWidths[i].half_width_m + 0.075, kRounding) << i;
  }
}

TEST(ClearSpace, IsWiderOnCantedTrackByWhatVehiclesLeanOut) {
  EXPECT_EQ(CantWidening_m(3.58, 0.05), 0.0) << "the reference line has the first 50 mm";
  EXPECT_EQ(CantWidening_m(0.5, 0.15), 0.0) << "below the roll centre nothing leans out";
  // 0.4 x 0.1 m x 3.08 m / 1.5 m.
  EXPECT_NEAR(CantWidening_m(3.58, 0.15), 0.0821, 1e-4);
  for (const double side : {-1.0, 1.0}) {
    EXPECT_NEAR(ClearSpace(ClearHalfWidths({}), std::nullopt, {0.0, 0.15}, side)[8].half_width_m,
                1.754 + 0.0821, 1e-4);
  }
}

TEST(ClearSpace, LeavesRoomForPantographsUnderAContactLine) {
  for (const TrackBend& bend : {TrackBend{}, TrackBend{1.0 / 100.0, 0.15}}) {
    const std::vector<HalfWidth> rows = ClearSpace(ClearHalfWidths({}), 5.3, bend, 1.0);
    EXPECT_EQ(rows.back(), (HalfWidth{5.2, 1.43}));
    EXPECT_EQ(rows[rows.size() - 2].half_width_m, 1.43);
    EXPECT_GE(rows[rows.size() - 3].half_width_m, 1.43);
    EXPECT_TRUE(std::ranges::is_sorted(rows, {}, &HalfWidth::height_m));
  }
  // Of 1.589 to 0.93 m, 1.43 m are reached after 0.159 of 0.659 of the way up.
  EXPECT_NEAR(ClearSpace(ClearHalfWidths({}), 5.3, {}, 1.0)[10].height_m,
              3.885 + 0.845 * 0.159 / 0.659, kRounding);
}

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
