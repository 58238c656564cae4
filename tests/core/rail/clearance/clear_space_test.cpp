#include "core/rail/clearance/clear_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

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

}  // namespace
}  // namespace railcast
