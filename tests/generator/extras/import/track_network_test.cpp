#include "generator/extras/import/network/track_network.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "core/rail/line/alignment_course.h"
#include "generator/extras/import/lines/line_heights.h"
#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/map/map_projection.h"
#include "generator/extras/import/map/read_map.h"
#include "generator/extras/import/network/line_world.h"
#include "generator/extras/import/structures/standing_world.h"

namespace railcast {
namespace {

using ::testing::SizeIs;

/// A line of 1000 m radius for 100 km/h, to which the rule gives a cant of 11.8 * 100^2 / 1000 - 60
/// = 58 mm, and a track that crosses it at 1:9 in the middle.
TEST(TrackNetwork, CrossesALineToWhichTheRuleAloneGivesCant) {
  RailMap map{.nodes = {}, .ways = {}, .things = {}, .attribution = "Test"};
  constexpr double kRadius_m = 1000.0;
  constexpr double kRule_mm = 58.0;
  constexpr double kMiddle_m = 750.0;
  const auto add = [&](const std::vector<Eigen::Vector2d>& places_m, const MapTags& tags) {
    MapWay way{static_cast<std::int64_t>(map.ways.size()), {}, tags};
    for (const Eigen::Vector2d& place_m : places_m) {
      const double turn_rad = place_m.x() / kRadius_m;
      const Eigen::Vector2d point_m =
          (kRadius_m - place_m.y()) * Eigen::Vector2d(std::sin(turn_rad), -std::cos(turn_rad));
      const auto known = std::ranges::find(map.nodes, point_m, &MapNode::place_m);
      way.nodes.push_back(static_cast<std::size_t>(known - map.nodes.begin()));
      if (known == map.nodes.end()) map.nodes.push_back({.place_m = point_m, .tags = {}});
    }
    map.ways.push_back(way);
  };
  std::vector<Eigen::Vector2d> line_m;
  std::vector<Eigen::Vector2d> across_m;
  for (double s_m = 0.0; s_m <= 2.0 * kMiddle_m; s_m += 25.0) {
    line_m.emplace_back(s_m, 0.0);
    const double d_m = std::clamp((kMiddle_m - s_m) / 9.0, -5.0, 5.0);
    if (std::abs(s_m - kMiddle_m) < 300.0) across_m.emplace_back(s_m, d_m);
  }
  add(line_m, {{"railway", "rail"}, {"maxspeed", "100"}});
  add(across_m, {{"railway", "rail"}, {"service", "yard"}});
  const TrackLine track = FindLines(map, 1000.0).front();
  ImportedLine line = ImportLine(map, track, {});
  LineWorld world = MakeLineWorld(map, track, line);
  AddSideTracks(map, track, line, {}, world);
  ASSERT_THAT(world.crossings, SizeIs(1));
  ASSERT_THAT(world.level, SizeIs(1));
  LineWorld in_cant = world;
  EXPECT_EQ(MakeStand(line.alignment, std::nullopt, in_cant), std::nullopt);
  EXPECT_THAT(in_cant.crossings, SizeIs(0));

  LevelCant(world.level, line.alignment);
  EXPECT_EQ(MakeStand(line.alignment, std::nullopt, world), std::nullopt);
  EXPECT_THAT(world.crossings, SizeIs(1));
  const Alignment alignment(line.alignment);
  const auto cant_mm = [&](double s_m) {
    return kStandardSpacing_mm * std::abs(std::sin(alignment.At(s_m).cant_rad));
  };
  // Places are in the file to 0.1 m, in which a ramp changes by 0.1 mm, and the radius is fitted.
  constexpr double kOff_mm = 0.1 + 0.02 * (kRule_mm + 60.0);
  const ChainageRange& level = world.level.front();
  EXPECT_NEAR(cant_mm(level.begin_s_m), 0.0, 0.1);
  EXPECT_NEAR(cant_mm(world.crossings[0].s_m), 0.0, 0.1);
  EXPECT_NEAR(cant_mm(level.end_s_m), 0.0, 0.1);
  EXPECT_NEAR(cant_mm(level.begin_s_m - 30.0), 0.5 * kRule_mm, kOff_mm);
  EXPECT_NEAR(cant_mm(level.begin_s_m - 70.0), kRule_mm, kOff_mm);
  EXPECT_NEAR(cant_mm(level.end_s_m + 70.0), kRule_mm, kOff_mm);
}

/// A crossing with a turnout 10 m behind it, and yard tracks of which 30 and 54 m run along the
/// line: three of eight switches were missing. Two more lie where the line ends.
TEST(TrackNetwork, HasEachSwitchOnATrackInKarlsruhe) {
  const std::filesystem::path file =
      RAILCAST_SHARED_DATA_DIR "/osm_more/karlsruhe-kirchfeld.osm.pbf";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  RailMap map = ReadMap(file);
  static_cast<void>(ProjectMap("", map));
  const TrackLine track = FindLines(map, 1000.0).front();
  const ImportedLine line = ImportLine(map, track, {});
  LineWorld world = MakeLineWorld(map, track, line);
  AddSideTracks(map, track, line, {}, world);
  EXPECT_EQ(MakeStand(line.alignment, std::nullopt, world), std::nullopt);
  EXPECT_EQ(world.quality.num_switches, 10U);
  EXPECT_THAT(world.switches, SizeIs(8));
  const auto is_at_end = [](const LeftOut& thing) { return thing.reason == kAtLinesEnd; };
  EXPECT_EQ(std::ranges::count_if(world.left_out, is_at_end), 2);
  EXPECT_THAT(world.crossings, SizeIs(1));
}

}  // namespace
}  // namespace railcast
