#include "viewer/overlays/overlays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/rail/clearance/clear_space.h"
#include "tests/viewer/overlays/made_line.h"

namespace railcast {
namespace {

/// Without a contact line, of both sides.
constexpr std::size_t kCorners = 2 * kClearHalfWidths.size();

TEST(ClearSpaceOverlay, RingsEveryTenMetresOfChainage) {
  ScenarioSpec scenario = ScenarioOnLine(Straight(2'000.0), 1'003.0);
  scenario.world.catenary.enabled = false;
  const Surroundings surroundings = SurroundingsOf(scenario);
  const Overlay drawing = DrawClearSpace(surroundings, FrameOf(surroundings));
  // The rings are at the tens from 993 to 1153 and have as many sides as corners; from each of
  // these an edge follows, of 160 segments between 161 whole metres.
  constexpr std::size_t kRings = 16;
  ASSERT_EQ(drawing.segments.size(), kCorners * (kRings + 160));
  const double sensor_s_m = 1'003.0 + scenario.lidar.mount.position_m[0];
  for (std::size_t i = 0; i < kCorners * kRings; ++i) {
    const std::size_t ring = i / kCorners;
    const double s_m = 1'000.0 + 10.0 * static_cast<double>(ring);
    EXPECT_NEAR(static_cast<double>(drawing.segments[i].from_m.x()), s_m - sensor_s_m, 1e-4);
    EXPECT_NEAR(static_cast<double>(drawing.segments[i].to_m.x()), s_m - sensor_s_m, 1e-4);
  }
}

TEST(ClearSpaceOverlay, LeansWithTheCantAndFollowsTheCurve) {
  constexpr double kRadius_m = 300.0;
  AlignmentSpec line = Arc(800.0, kRadius_m);
  line.speed_limits_kmph = {{0.0, 200.0}};  // So fast that the cant is at its maximum.
  ScenarioSpec scenario = ScenarioOnLine(line, 300.0);
  scenario.world.catenary.enabled = false;
  const Surroundings surroundings = SurroundingsOf(scenario);
  const RecordedFrame recorded = FrameOf(surroundings);
  const Overlay drawing = DrawClearSpace(surroundings, recorded);
  // The cant is 150 mm across 1500 mm; in a left curve the left side is the lower one.
  const double cant_rad = std::asin(0.1);
  const Eigen::Rotation2Dd lean(-cant_rad);
  const TrackBend bend{1.0 / kRadius_m, 0.15};
  const std::vector<HalfWidth> left = ClearSpace(ClearHalfWidths({}), std::nullopt, bend, 1.0);
  const std::vector<HalfWidth> right = ClearSpace(ClearHalfWidths({}), std::nullopt, bend, -1.0);
  for (std::size_t i = 0; i < drawing.segments.size(); ++i) {
    const std::size_t corner = i % kCorners;
    const bool is_left = corner < left.size();
    const HalfWidth& row = is_left ? left[corner] : right[kCorners - 1 - corner];
    const Vector3 world =
        recorded.frame.world_from_sensor * drawing.segments[i].from_m.cast<double>();
    const double radius_m = (world - Vector3(0.0, kRadius_m, 0.0)).head<2>().norm();
    const Eigen::Vector2d expected =
        lean * Eigen::Vector2d(is_left ? row.half_width_m : -row.half_width_m, row.height_m);
    // Float32 is far more precise; with the tangent of the cant in place of its sine, the corners
    // would be 2 mm off.
    ASSERT_NEAR(kRadius_m - radius_m, expected.x(), 1e-3) << i;
    ASSERT_NEAR(world.z(), expected.y(), 1e-3) << i;
  }
}

TEST(ClearSpaceOverlay, LeavesRoomForPantographsOnlyUnderAContactLine) {
  ScenarioSpec scenario = ScenarioOnLine(Straight(2'000.0), 1'000.0);
  const auto top_m = [](const ScenarioSpec& spec) {
    const Surroundings surroundings = SurroundingsOf(spec);
    float highest_m = -10.0F;
    for (const auto& segment : DrawClearSpace(surroundings, FrameOf(surroundings)).segments) {
      highest_m = std::max(highest_m, segment.from_m.z());
    }
    return static_cast<double>(highest_m) + spec.lidar.mount.position_m[2];
  };
  EXPECT_NEAR(top_m(scenario), 5.2, 1e-5);
  scenario.world.tracks[0].electrified = false;
  EXPECT_NEAR(top_m(scenario), 4.73, 1e-5);
}

}  // namespace
}  // namespace railcast
