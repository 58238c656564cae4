#include "core/rail/landform/landform.h"

#include "tests/support/world_specs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace railcast {
namespace {

Alignment LineOfElements(std::vector<AlignmentElement> elements) {
  return Alignment(AlignmentOf(std::move(elements)));
}

/// A quarter circle to the left between two straights.
Alignment Bend(double radius_m) {
  return LineOfElements({{ElementType::kStraight, 800.0, {}},
                         {ElementType::kArc, 0.5 * std::numbers::pi * radius_m, radius_m},
                         {ElementType::kStraight, 800.0, {}}});
}

TEST(StripWidth, IsTheSpecsEverywhereIfNoCurveIsAsTight) {
  const StripWidth width(Bend(190.0), 189.0);
  EXPECT_FALSE(width.narrows());
  EXPECT_EQ(width.At(900.0, 1.0), 189.0);
  EXPECT_EQ(width.least_m(), 189.0);
}

TEST(StripWidth, IsFourFifthsOfTheRadiusInsideACurveAndTheSpecsOutside) {
  const Alignment line = Bend(190.0);
  const StripWidth width(line, 300.0);
  EXPECT_TRUE(width.narrows());
  EXPECT_NEAR(width.At(800.0 + 0.25 * std::numbers::pi * 190.0, 1.0), 152.0, 1e-6);
  EXPECT_NEAR(width.least_m(), 152.0, 1e-6);
  for (double s_m = 0.0; s_m <= line.length_m(); s_m += 7.0) EXPECT_EQ(width.At(s_m, -1.0), 300.0);
  EXPECT_EQ(width.At(0.0, 1.0), 300.0);
  EXPECT_EQ(width.At(line.length_m(), 1.0), 300.0);
}

TEST(StripWidth, NarrowsByAtMostHalfAMetrePerMetre) {
  const Alignment line = Bend(100.0);
  const StripWidth width(line, 400.0);
  for (double s_m = 0.0; s_m < line.length_m(); s_m += 1.0) {
    EXPECT_LE(std::abs(width.At(s_m + 1.0, 1.0) - width.At(s_m, 1.0)),
              StripWidth::kNarrowing + 1e-9);
  }
}

// Cross-sections do not meet if every place of the ground is nearer to its own place of the axis
// than to any other.
TEST(StripWidth, LeavesEveryPlaceNearestToItsOwnChainage) {
  const Alignment hairpin = LineOfElements({{ElementType::kStraight, 900.0, {}},
                                            {ElementType::kArc, 190.0 * std::numbers::pi, 190.0},
                                            {ElementType::kStraight, 900.0, {}}});
  const StripWidth width(hairpin, 300.0);
  for (double s_m = 0.0; s_m < hairpin.length_m(); s_m += 23.0) {
    for (const double side : {-1.0, 1.0}) {
      const double reach_m = width.At(s_m, side);
      EXPECT_GE(reach_m, 150.0);
      const Eigen::Vector2d edge_m =
          hairpin.WorldFromTrack(s_m, side * reach_m).translation().head<2>();
      for (double other_s_m = 0.0; other_s_m < hairpin.length_m(); other_s_m += 5.0) {
        const Eigen::Vector2d other_m = hairpin.At(other_s_m).position_m.head<2>();
        EXPECT_GT((edge_m - other_m).norm(), reach_m - 0.1) << s_m << ", " << other_s_m;
      }
    }
  }
}

}  // namespace
}  // namespace railcast
