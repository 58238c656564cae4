#include "generator/extras/import/structures/standing_world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/io/write_file.h"
#include "generator/extras/import/map/map_projection.h"
#include "generator/extras/import/map/read_map.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/import/made_map.h"
#include "tests/generator/run_command.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

WorldTrack TrackBeside(const std::string& name, double offset_m) {
  WorldTrack track{{{}, TrackCourse(100.0, 900.0, offset_m), {}, {}, 0}, {}};
  track.draft.spec.name = name;
  track.draft.spec.offset_m = offset_m;
  track.draft.spec.start_s_m = 100.0;
  track.draft.spec.end_s_m = 900.0;
  return track;
}

TEST(StandingWorld, IsLeftAsItIsIfCheckHasNothingAgainstIt) {
  MadeMap map = ImportedTracks({{0.0, {{"tunnel", "yes"}}}, {4.5, {}}});
  EXPECT_EQ(MakeStand(map.line().alignment, std::nullopt, map.world()), std::nullopt);
  EXPECT_EQ(map.world().tracks.size(), 2U);
  EXPECT_THAT(map.All<TunnelSpec>(), SizeIs(1));
  EXPECT_THAT(map.world().left_out, IsEmpty());
}

TEST(StandingWorld, LosesTheTracksThatCheckRefusesWithAllThatStandsOnThem) {
  MadeMap map = ImportedTracks({{0.0, {}}});
  LineWorld& world = map.world();
  world.tracks.push_back(TrackBeside("far", 82.5));
  world.tracks.push_back(TrackBeside("near", 2.0));
  world.tracks.push_back(TrackBeside("good", 5.0));
  SlabTrackSpec slab;
  slab.name = "slab";
  slab.track = "far";
  slab.begin_s_m = 200.0;
  slab.end_s_m = 300.0;
  world.structures.push_back(slab);
  EXPECT_EQ(MakeStand(map.line().alignment, std::nullopt, world), std::nullopt);
  ASSERT_THAT(world.tracks, SizeIs(2));
  EXPECT_EQ(world.tracks[1].draft.spec.name, "good");
  EXPECT_THAT(world.structures, IsEmpty());
  EXPECT_THAT(map.ReasonsFor("track far"),
              ElementsAre("it must lie within the ground's half width of 80 m (got 82.5)"));
  EXPECT_THAT(map.ReasonsFor("track near"), SizeIs(1));
  EXPECT_THAT(map.ReasonsFor("slab_track"), SizeIs(1));
  EXPECT_EQ(world.left_out.front().begin_s_m, 100.0);
  EXPECT_EQ(world.left_out.front().end_s_m, 900.0);
}

TEST(StandingWorld, IsNoneIfTheLineItselfIsRefused) {
  MadeMap map = ImportedTracks({{0.0, {}}});
  AlignmentSpec alignment = map.line().alignment;
  alignment.speed_limits_kmph = {{0.0, -1.0}};
  const auto fault = MakeStand(alignment, std::nullopt, map.world());
  ASSERT_TRUE(fault);
  EXPECT_THAT(*fault, ::testing::HasSubstr("/world/alignment/speed_limits_kmph"));
}

constexpr const char* kMapOfLine = R"({"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"railway": "rail", "name": "Hill Line", "maxspeed": "60"},
   "geometry": {"type": "LineString", "coordinates":
    [[15.60, 48.20], [15.61, 48.20], [15.62, 48.2003], [15.63, 48.201]]}}]})";

/// A person in the world that was imported into `out`.
std::shared_ptr<const RailWorld> WorldWithPerson(const fs::path& out, json place) {
  json person = {{"name", "person"}, {"type", "person"}};
  person.update(place);
  const json scenario = {
      {"version", 1},
      {"file", RAILCAST_SOURCE_DIR "/scenarios/minimal.json"},
      {"world",
       {{"file", (out / "hill-line.world.json").string()}, {"objects", json::array({person})}}}};
  return MakeWorld(ReadScenarioText(scenario.dump(), out / "scenario.json"));
}

Eigen::Vector2d PlaceInPlan_m(const RailWorld& world) {
  return world.WorldFromObject(0, 0).translation().head<2>();
}

TEST(PlacedOnMap, APersonStandsAtANodeOfTheMapInEveryWayOfPlacing) {
  // PROJ's metres, the polynomial of a given system, and the place beside the track.
  constexpr double kTolerance_m = 1e-3;
  for (const std::string& crs : {std::string(), std::string("EPSG:31256")}) {
    const TemporaryDirectory directory;
    const fs::path file = directory.path() / "map.geojson";
    const fs::path out = directory.path() / "out";
    WriteFileWhole(file, kMapOfLine);
    const Ended run = Generate("import " + file.string() + " --out " + out.string() +
                               (crs.empty() ? "" : " --crs " + crs));
    ASSERT_EQ(run.status, 0) << run.said;
    RailMap map = ReadMap(file);
    const MapProjection projection = ProjectMap(crs, map);
    for (const std::size_t node : {1U, 2U}) {
      const MapNode& there = map.nodes.at(node);
      const auto world = WorldWithPerson(out, {{"longitude_deg", there.geographic_deg.x()},
                                               {"latitude_deg", there.geographic_deg.y()}});
      EXPECT_LT((PlaceInPlan_m(*world) - there.place_m).norm(), kTolerance_m) << crs;

      const Eigen::Vector2d projected_m = there.place_m + projection.origin_m;
      const auto by_projection =
          WorldWithPerson(out, {{"x_m", projected_m.x()}, {"y_m", projected_m.y()}});
      EXPECT_LT((PlaceInPlan_m(*by_projection) - there.place_m).norm(), kTolerance_m) << crs;

      const double s_m = world->ObjectChainage_m(0, 0);
      const AxisPoint axis = world->alignment().At(s_m);
      const Eigen::Vector2d off_m = there.place_m - axis.position_m.head<2>();
      const double d_m =
          std::cos(axis.heading_rad) * off_m.y() - std::sin(axis.heading_rad) * off_m.x();
      // What the fit leaves of a map's points.
      EXPECT_LT(std::abs(d_m), 2.0);
      const auto beside = WorldWithPerson(out, {{"s_m", s_m}, {"d_m", d_m}});
      EXPECT_LT((PlaceInPlan_m(*beside) - PlaceInPlan_m(*world)).norm(), kTolerance_m) << crs;
    }
  }
}

const MapTags kTunnelTags = {{"tunnel", "yes"}};

/// A siding that leaves the line by 1:9 to the north at 1000 m.
void AddSiding(MadeMap& map) {
  std::vector<Eigen::Vector2d> points_m = {{1000.0, 0.0}};
  for (double x_m = 5.0; x_m < 40.5; x_m += 5.0) points_m.emplace_back(1000.0 + x_m, x_m / 9.0);
  for (double x_m = 1040.5; x_m < 1500.0; x_m += 20.0) points_m.emplace_back(x_m, 4.5);
  map.AddWay(points_m, {{"service", "siding"}});
}

TEST(ClearStructures, CutsAPlatformWhereATrackRunsThroughIt) {
  MadeMap map{{0.0, {}}};
  AddSiding(map);
  map.Make();
  PlatformSpec platform;
  platform.begin_s_m = 900.0;
  platform.end_s_m = 1100.0;
  platform.side = map.north();
  map.world().structures = {platform};
  ClearStructures(map.line().alignment, map.world());
  const PlatformSpec left = map.Only<PlatformSpec>();
  const std::vector<double> ends_m = map.PlacesOf_x_m(left);
  EXPECT_NEAR(ends_m[0], 900.0, 0.01);
  // Platforms must be farther from the turnout's curve than this one is. It is cut 1 m before the
  // turnout begins, 10.5 m before the tangents meet, or a little later.
  EXPECT_GT(ends_m[1], 988.0);
  EXPECT_LT(ends_m[1], 1000.0);
  EXPECT_THAT(map.ReasonsFor("platform"),
              ElementsAre(StartsWith("it would stand in the clear space of track siding_1")));
}

TEST(ClearStructures, LeavesOutAThingThatStandsInAGauge) {
  MadeMap map = ImportedTracks({{0.0, {}}, {4.5, {}}});
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
  MadeMap map{{0.0, {}}};
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
  MadeMap map = ImportedTracks({{0.0, kTunnelTags}, {10.0, kTunnelTags}});
  ClearStructures(map.line().alignment, map.world());
  EXPECT_THAT(map.All<TunnelSpec>(), SizeIs(2));
  EXPECT_THAT(map.ReasonsFor("tunnel"), IsEmpty());
}

TEST(ClearStructures, KeepsWhatIsBetweenTwoPlacesThatAreInTheWay) {
  MadeMap map{{0.0, {}}};
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
    MadeMap map = ImportedTracks({{0.0, kTunnelTags}, {y_m, {}}});
    ClearStructures(map.line().alignment, map.world());
    ASSERT_THAT(map.All<TunnelSpec>(), SizeIs(1)) << y_m;
    EXPECT_EQ(map.All<TunnelSpec>()[0].has_portals, has_portals) << y_m;
    EXPECT_NEAR(map.All<TunnelSpec>()[0].end_s_m, 1200.0, 1.0) << y_m;
  }
}

}  // namespace
}  // namespace railcast
