#include "core/rail/line/rail_section.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace railcast {
namespace {

double Area(const std::vector<Eigen::Vector2d>& outline_m) {
  double twice_m2 = 0.0;
  for (std::size_t i = 0; i < outline_m.size(); ++i) {
    const Eigen::Vector2d& a = outline_m[i];
    const Eigen::Vector2d& b = outline_m[(i + 1) % outline_m.size()];
    twice_m2 += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice_m2;
}

// The outline is clockwise, hence the negative sign. docs/physics.md 7.1 gives the polygon's area
// to four digits.
TEST(RailSection, HasTheAreaOfThe60E1Polygon) {
  EXPECT_NEAR(Area(MakeRailSection(true).outline_m), -77.07e-4, 0.005e-4);
  EXPECT_NEAR(Area(MakeRailSection(false).outline_m), -77.07e-4, 0.005e-4);
}

TEST(RailSection, TouchesTopOfRailAndStandsOneRailHeightHigh) {
  const RailSection section = MakeRailSection(true);
  double top_m = -1.0;
  for (const Eigen::Vector2d& point : section.outline_m) top_m = std::max(top_m, point.y());
  EXPECT_DOUBLE_EQ(top_m, 0.0);
  // Due to the inclination of 1:40, the middle of the foot is higher by 172 mm (1 - cos) = 0.05 mm,
  // and the highest point differs from the crown: 0.1 mm.
  EXPECT_NEAR(RailFootMiddle_m().y(), -kRailHeight_m, 0.15e-3);
}

TEST(RailSection, LeansTowardsTheTracksMiddleByOneInForty) {
  const RailSection left = MakeRailSection(true);
  const Eigen::Vector2d foot_m = left.outline_m.back() - left.outline_m.front();
  EXPECT_NEAR(foot_m.y() / foot_m.x(), 1.0 / 40.0, 1e-12);
  const RailSection right = MakeRailSection(false);
  const Eigen::Vector2d right_foot_m = right.outline_m.back() - right.outline_m.front();
  EXPECT_NEAR(right_foot_m.y() / right_foot_m.x(), -1.0 / 40.0, 1e-12);
}

TEST(RailSection, HasARunningBand52MillimetresWide) {
  const RailSection section = MakeRailSection(true);
  const Eigen::Vector2d band_m =
      section.outline_m[section.head_last] - section.outline_m[section.head_first];
  EXPECT_NEAR(band_m.norm(), 0.052, 1e-12);
}

}  // namespace
}  // namespace railcast
