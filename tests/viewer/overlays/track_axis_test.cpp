#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/rail/clearance/clear_space.h"
#include "tests/viewer/overlays/made_line.h"
#include "viewer/overlays/overlays.h"

namespace railcast {
namespace {

constexpr double kWordTick_m = 1.3;

/// Returns whether a segment is a short tick: 1 m long and across the track, not along it.
/// @pre The sensor looks along the track.
bool IsTick(const Overlay::Segment& segment) {
  const Eigen::Vector3f way = segment.to_m - segment.from_m;
  return std::abs(way.norm() - 1.0F) < 1e-3F && std::abs(way.y()) > 0.9F;
}

const Overlay::Word* FindWord(const Overlay& drawing, const std::string& text) {
  const auto found = std::ranges::find(drawing.words, text, &Overlay::Word::text);
  return found == drawing.words.end() ? nullptr : &*found;
}

TEST(TrackAxis, PutsTheWordOfAChainageWhereItIs) {
  AlignmentSpec line = Straight(30'000.0);
  line.origin_m = {700'000.0, 250'000.0, 400.0};
  line.heading_deg = 30.0;
  const Surroundings surroundings = SurroundingsOf(ScenarioOnLine(line, 29'013.0));
  const Overlay drawing = DrawTrackAxis(surroundings, FrameOf(surroundings));
  const Overlay::Word* word = FindWord(drawing, "km 29.350");
  ASSERT_NE(word, nullptr);
  const MountSpec& mount = surroundings.scenario.lidar.mount;
  const Vector3 expected(29'350.0 - 29'013.0 - mount.position_m[0],
                         kWordTick_m - mount.position_m[1], -mount.position_m[2]);
  EXPECT_LT((word->at_m.cast<double>() - expected).norm(), 1e-3);
}

TEST(TrackAxis, TicksEveryTenMetresAndWritesEveryFifty) {
  const Surroundings surroundings = SurroundingsOf(ScenarioOnLine(Straight(2'000.0), 1'003.0));
  const Overlay drawing = DrawTrackAxis(surroundings, FrameOf(surroundings));
  std::vector<std::string> texts;
  for (const Overlay::Word& word : drawing.words) texts.push_back(word.text);
  EXPECT_THAT(texts,
              testing::ElementsAre("km 1.000", "km 1.050", "km 1.100", "km 1.150", "km 1.200",
                                   "km 1.250", "km 1.300", "km 1.350", "km 1.400"));
  // There are 45 multiples of 10 m from 960 to 1400, nine of them with words.
  EXPECT_EQ(std::ranges::count_if(drawing.segments, IsTick), 45 - 9);
}

TEST(TrackAxis, FollowsAnArcToFiveMillimetres) {
  constexpr double kRadius_m = 300.0;
  constexpr double kOffset_m = 4.0;
  ScenarioSpec scenario = ScenarioOnLine(Arc(800.0, kRadius_m), 100.0);
  scenario.world.tracks[0].offset_m = kOffset_m;
  const Surroundings surroundings = SurroundingsOf(scenario);
  const RecordedFrame recorded = FrameOf(surroundings);
  const Overlay drawing = DrawTrackAxis(surroundings, recorded);
  // There is one segment per metre, because both ends are whole metres. Rounding of float32 at 400
  // m adds 3e-5.
  for (std::size_t i = 0; i < 450; ++i) {
    const Overlay::Segment& segment = drawing.segments[i];
    const Vector3 middle = 0.5 * (segment.from_m + segment.to_m).cast<double>();
    for (const Vector3& place : {Vector3(segment.from_m.cast<double>()), middle}) {
      const Vector3 world = recorded.frame.world_from_sensor * place;
      const double radius_m = (world - Vector3(0.0, kRadius_m, 0.0)).head<2>().norm();
      ASSERT_NEAR(radius_m, kRadius_m - kOffset_m, 1.0 / (8.0 * kRadius_m) + 1e-4);
      ASSERT_NEAR(world.z(), 0.0, 1e-4);
    }
  }
}

TEST(TrackAxis, GoesFrom50MetresBehindTo400Ahead) {
  const Surroundings surroundings = SurroundingsOf(ScenarioOnLine(Straight(2'000.0), 1'000.5));
  const Overlay drawing = DrawTrackAxis(surroundings, FrameOf(surroundings));
  const auto to_vehicle_m = static_cast<float>(surroundings.scenario.lidar.mount.position_m[0]);
  EXPECT_NEAR(drawing.segments[0].from_m.x() + to_vehicle_m, -50.0F, 1e-4F);
  float farthest_m = 0.0F;
  for (const auto& segment : drawing.segments) farthest_m = std::max(farthest_m, segment.to_m.x());
  EXPECT_NEAR(farthest_m + to_vehicle_m, 400.0F, 1e-4F);
}

TEST(TrackAxis, LooksAheadOfAVehicleThatRunsAgainstTheChainage) {
  ScenarioSpec scenario = ScenarioOnLine(Straight(2'000.0), 1'000.0);
  scenario.vehicle.motion.reverse = true;
  const Surroundings surroundings = SurroundingsOf(scenario);
  const Overlay drawing = DrawTrackAxis(surroundings, FrameOf(surroundings));
  EXPECT_NE(FindWord(drawing, "km 0.600"), nullptr);
  EXPECT_NE(FindWord(drawing, "km 1.050"), nullptr);
  EXPECT_EQ(FindWord(drawing, "km 1.100"), nullptr);
  EXPECT_GT(FindWord(drawing, "km 0.600")->at_m.x(), 390.0F);
}

TEST(TrackAxis, EndsWhereTheTrackEnds) {
  ScenarioSpec scenario = ScenarioOnLine(Straight(2'000.0), 1'000.0);
  scenario.world.tracks[0].end_s_m = 1'105.0;
  scenario.world.tracks[0].start_s_m = 955.0;
  const Surroundings surroundings = SurroundingsOf(scenario);
  const Overlay drawing = DrawTrackAxis(surroundings, FrameOf(surroundings));
  const auto to_vehicle_m = static_cast<float>(scenario.lidar.mount.position_m[0]);
  for (const auto& segment : drawing.segments) {
    EXPECT_GT(segment.from_m.x() + to_vehicle_m, -45.001F);
    EXPECT_LT(segment.to_m.x() + to_vehicle_m, 105.001F);
  }
  EXPECT_EQ(drawing.words.size(), 3U);
}

TEST(TrackAxis, IsNotThereWithoutAPose) {
  const Surroundings surroundings = SurroundingsOf(ScenarioOnLine(Straight(2'000.0), 1'000.0));
  RecordedFrame recorded = FrameOf(surroundings);
  recorded.has_pose = false;
  EXPECT_THAT(DrawTrackAxis(surroundings, recorded).segments, testing::IsEmpty());
}

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
