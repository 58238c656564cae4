#include "generator/extras/import/structures/standing_world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>


#include "tests/generator/extras/import/made_map.h"

namespace railcast {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

const MapTags kTunnelTags = {{"tunnel", "yes"}};

/// A siding that leaves the line by 1:9 to the north at 1000 m.
void AddSiding(MadeMap& map) {
  std::vector<Eigen::Vector2d> points_m = {{1000.0, 0.0}};
  for (double x_m = 5.0; x_m < 40.5; x_m += 5.0) points_m.emplace_back(1000.0 + x_m, x_m / 9.0);
  for (double x_m = 1040.5; x_m < 1500.0; x_m += 20.0) points_m.emplace_back(x_m, 4.5);
  map.AddWay(points_m, {{"service", "siding"}});
}

TEST(ClearStructures, CutsAPlatformWhereATrackRunsThroughIt) {
  MadeMap map;
  map.AddTrack(0.0, {});
  AddSiding(map);
  map.Make();
  PlatformSpec platform;
  platform.begin_s_m = 900.0;
  platform.end_s_m = 1100.0;
  platform.side = map.north();
  map.world().structures = {platform};
  ClearStructures(map.line().alignment, map.world());
  const std::vector<PlatformSpec> platforms = map.All<PlatformSpec>();
  ASSERT_THAT(platforms, SizeIs(1));
  const std::vector<double> ends_m = map.PlacesOf_x_m(platforms[0]);
  EXPECT_NEAR(ends_m[0], 900.0, 0.01);
  // Platforms must be farther from the turnout's curve than this one is. It is cut 1 m before the
  // turnout begins, 10.5 m before the tangents meet, or a little later.
  EXPECT_GT(ends_m[1], 988.0);
  EXPECT_LT(ends_m[1], 1000.0);
  EXPECT_THAT(map.ReasonsFor("platform"),
              ElementsAre(StartsWith("it would stand in the clear space of track siding_1")));
}

TEST(ClearStructures, LeavesOutAThingThatStandsInAGauge) {
  MadeMap map;
  map.AddTrack(0.0, {});
  map.AddTrack(4.5, {});
  map.Make();
  SignalSpec signal;
  signal.s_m = 1000.0;
  signal.side = map.north();
  BoardSpec board;
  board.s_m = 1000.0;
  board.kind = BoardKind::kKilometre;
  board.side = map.south();
  map.world().structures = {signal, board};
  ClearStructures(map.line().alignment, map.world());
  EXPECT_THAT(map.All<SignalSpec>(), IsEmpty()) << "it stood 1.4 m beside the other track";
  ASSERT_THAT(map.All<BoardSpec>(), SizeIs(1));
  EXPECT_EQ(map.All<BoardSpec>()[0].name, "board_1");
  EXPECT_THAT(map.ReasonsFor("signal"),
              ElementsAre("it would stand in the clear space of track running_1"));
}

TEST(ClearStructures, LeavesOutWhatAWorldRefuses) {
  MadeMap map;
  map.AddTrack(0.0, {});
  AddSiding(map);
  map.Make();
  LevelCrossingSpec crossing;
  crossing.s_m = map.ChainageAt_m(1000.0);
  map.world().structures = {crossing};
  ClearStructures(map.line().alignment, map.world());
  EXPECT_THAT(map.world().structures, IsEmpty());
  EXPECT_THAT(map.ReasonsFor("level_crossing"),
              ElementsAre("it must not put the road into a turnout"));
}

TEST(ClearStructures, KeepsTunnelsWhoseLiningsTouchOutsideOfAllGauges) {
  MadeMap map;
  map.AddTrack(0.0, kTunnelTags);
  map.AddTrack(10.0, kTunnelTags);
  map.Make();
  ClearStructures(map.line().alignment, map.world());
  EXPECT_THAT(map.All<TunnelSpec>(), SizeIs(2));
  EXPECT_THAT(map.ReasonsFor("tunnel"), IsEmpty());
}

TEST(ClearStructures, KeepsWhatIsBetweenTwoPlacesThatAreInTheWay) {
  MadeMap map;
  map.AddTrack(0.0, {});
  // A loop from 600 to 1400 m to the north.
  std::vector<Eigen::Vector2d> points_m = {{600.0, 0.0}};
  for (double x_m = 5.0; x_m < 40.5; x_m += 5.0) points_m.emplace_back(600.0 + x_m, x_m / 9.0);
  for (double x_m = 640.5; x_m < 1360.0; x_m += 40.0) points_m.emplace_back(x_m, 4.5);
  for (double x_m = 40.5; x_m > 0.0; x_m -= 5.0) points_m.emplace_back(1400.0 - x_m, x_m / 9.0);
  points_m.emplace_back(1400.0, 0.0);
  map.AddWay(points_m, {{"service", "siding"}});
  map.Make();
  ASSERT_EQ(map.world().tracks.size(), 2U);
  PlatformSpec platform;
  platform.begin_s_m = 500.0;
  platform.end_s_m = 1500.0;
  platform.width_m = 1.0;
  platform.side = map.north();
  map.world().structures = {platform};
  ClearStructures(map.line().alignment, map.world());
  const std::vector<PlatformSpec> platforms = map.All<PlatformSpec>();
  ASSERT_THAT(platforms, SizeIs(3));
  // The branch is parallel some metres behind the end of the points at 1:9.
  EXPECT_LT(platforms[1].begin_s_m, 640.5 + 25.0);
  EXPECT_GT(platforms[1].end_s_m, 1359.5 - 25.0);
  ASSERT_THAT(map.ReasonsFor("platform"), SizeIs(2));
  EXPECT_GT(map.world().left_out.back().begin_s_m, 1300.0) << "from where to where it is left out";
  EXPECT_LT(map.world().left_out.back().end_s_m, 1420.0);
}

TEST(ClearStructures, LeavesOutOnlyThePortalsWhereTheseStandInAGauge) {
  // The lining is 5.6 m from the axis, the portal 7.6 m, and the gauge 1.575 m.
  for (const auto& [y_m, has_portals] : {std::pair(7.5, false), std::pair(9.5, true)}) {
    MadeMap map;
    map.AddTrack(0.0, kTunnelTags);
    map.AddTrack(y_m, {});
    map.Make();
    ClearStructures(map.line().alignment, map.world());
    ASSERT_THAT(map.All<TunnelSpec>(), SizeIs(1)) << y_m;
    EXPECT_EQ(map.All<TunnelSpec>()[0].has_portals, has_portals) << y_m;
    EXPECT_NEAR(map.All<TunnelSpec>()[0].end_s_m, 1200.0, 1.0) << y_m;
  }
}

}  // namespace
}  // namespace railcast
