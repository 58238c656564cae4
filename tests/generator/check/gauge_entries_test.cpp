#include "core/rail/world/gauge_entries.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/rail/network/network_draft.h"
#include "generator/check/check_report.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

/// A curve of 400 m radius to the left with two tracks, without cant.
WorldSpec CurveOfTwoTracks() {
  WorldSpec world;
  world.alignment.course = AlignmentElementsSpec{{{ElementType::kArc, 300.0, 400.0}}};
  world.tracks.push_back({.name = "second", .offset_m = 4.0, .end_s_m = {}});
  return world;
}

std::vector<GaugeEntry> EntriesOf(const WorldSpec& world) {
  ScenarioSpec scenario = ReadScenario(RAILCAST_SOURCE_DIR "/scenarios/minimal.json");
  scenario.world = world;
  scenario.vehicle.start_s_m = 0.0;
  return FindGaugeEntries(world, *MakeWorld(scenario));
}

PlatformSpec PlatformAt(double edge_distance_m) {
  PlatformSpec platform;
  platform.name = "west";
  platform.side = TrackSide::kRight;
  platform.begin_s_m = 80.0;
  platform.end_s_m = 220.0;
  platform.edge_distance_m = edge_distance_m;
  return platform;
}

ObjectSpec BoxAt(double s_m, double d_m, const std::array<double, 3>& size_m) {
  ObjectSpec object;
  object.name = "box";
  object.type = ObjectType::kBox;
  object.s_m = s_m;
  object.d_m = d_m;
  object.h_m = 0.0;
  object.size_m = size_m;
  return object;
}

TEST(GaugeEntries, AreNoneOfAPlatformAtItsUsualDistance) {
  WorldSpec world = CurveOfTwoTracks();
  world.structures = {PlatformAt(1.65)};
  EXPECT_TRUE(EntriesOf(world).empty());
}

TEST(GaugeEntries, HoldPlatformsToTheDistanceThatTheCurveNeeds) {
  WorldSpec world = CurveOfTwoTracks();
  for (const double radius_m : {300.0, -300.0, 190.0, -190.0}) {
    world.alignment.course = AlignmentElementsSpec{{{ElementType::kArc, 300.0, radius_m}}};
    world.structures = {PlatformAt(1.65)};
    EXPECT_TRUE(EntriesOf(world).empty()) << radius_m;
    world.structures = {PlatformAt(1.62)};
    const std::vector<GaugeEntry> entries = EntriesOf(world);
    ASSERT_EQ(entries.size(), 1U) << radius_m;
    EXPECT_NEAR(entries[0].depth_m, 0.03 - 0.005, 4e-3) << radius_m;
  }
}

TEST(GaugeEntries, TakeMovingBarriersAtTheirLowest) {
  LevelCrossingSpec crossing;
  crossing.name = "crossing";
  crossing.s_m = 148.0;
  crossing.road_length_m = 25.0;
  WorldSpec world = CurveOfTwoTracks();
  // A track that ends before the road, in whose gauge its closed boom lies.
  world.tracks[1].offset_m = 4.7;
  world.tracks[1].end_s_m = 150.0;
  world.structures = {crossing};
  const std::vector<GaugeEntry> closed = EntriesOf(world);
  ASSERT_FALSE(closed.empty());
  crossing.barrier_angles_deg = {{0.0, 85.0}, {10.0, 0.0}, {20.0, 85.0}};
  world.structures = {crossing};
  const std::vector<GaugeEntry> moving = EntriesOf(world);
  ASSERT_EQ(moving.size(), closed.size());
  EXPECT_EQ(moving[0].begin_s_m, closed[0].begin_s_m);
  EXPECT_EQ(moving[0].depth_m, closed[0].depth_m);
}

TEST(GaugeEntries, NameAPlatformTooNearWithItsStretchAndDepth) {
  WorldSpec world = CurveOfTwoTracks();
  world.structures = {PlatformAt(1.5)};
  const std::vector<GaugeEntry> entries = EntriesOf(world);
  ASSERT_EQ(entries.size(), 1U);
  EXPECT_EQ(entries[0].name, "west");
  EXPECT_EQ(entries[0].track, "main");
  // Pieces are measured at their middles, up to 2.5 m apart.
  EXPECT_NEAR(entries[0].begin_s_m, 80.0, 2.5);
  EXPECT_NEAR(entries[0].end_s_m, 220.0, 2.5);
  // Chords are at most 1 mm off, twice.
  EXPECT_NEAR(entries[0].depth_m, 1.645 - 1.5, 2.1e-3);
  // Only the nose, 0.12 m high: the wall below stands 0.08 m behind it.
  EXPECT_NEAR(entries[0].bottom_m, 0.76 - 0.12, 2e-3);
  EXPECT_NEAR(entries[0].top_m, 0.76, 2e-3);
}

TEST(GaugeEntries, HoldAStraightBoxThatLiesAcrossTheRailsInACurve) {
  // The line curves away from its middle to the left, by 60^2 / 8 R = 1.125 m at its ends.
  WorldSpec world = CurveOfTwoTracks();
  world.tracks.pop_back();
  world.objects = {BoxAt(150.0, -0.9, {60.0, 0.2, 1.0})};
  const std::vector<GaugeEntry> entries = EntriesOf(world);
  ASSERT_EQ(entries.size(), 1U);
  EXPECT_EQ(entries[0].track, "main");
  // The clear space is 1.672 m wide at 1 m: 1.6627 m (of 1.656 and 1.665), and 3.75 m^2 / 400 m.
  EXPECT_TRUE(entries[0].is_in_way);
  EXPECT_NEAR(entries[0].depth_m, 1.672 - 0.8, 0.01);
  EXPECT_NEAR(entries[0].top_m, 1.0, 1e-6);
  // It leaves that where its nearer face is so far from the axis: a sagitta of 0.872 m.
  const double half_m = std::sqrt(0.872 * 2.0 * 400.0);
  EXPECT_NEAR(entries[0].begin_s_m, 150.0 - half_m, 2.0);
  EXPECT_NEAR(entries[0].end_s_m, 150.0 + half_m, 2.0);
}

/// Posts of noise walls, of 0.16 m, stand out so far from the panels of 0.12 m.
constexpr double kPost_m = 0.02;

// A wagon's side is 1.575 m from the axis.
TEST(GaugeEntries, NameWhatIsNearAWagonThoughNotInItsWay) {
  WorldSpec world;
  world.alignment.course = AlignmentElementsSpec{{{ElementType::kStraight, 300.0, {}}}};
  NoiseWallSpec wall;
  wall.name = "wall";
  wall.begin_s_m = 20.0;
  wall.end_s_m = 290.0;
  wall.height_m = 3.0;
  wall.distance_m = 1.58 + kPost_m;
  world.structures = {wall};
  std::vector<GaugeEntry> entries = EntriesOf(world);
  ASSERT_EQ(entries.size(), 1U);
  EXPECT_FALSE(entries[0].is_in_way);
  // Of 1.754 m at 3.58 m, 0.064 m more than at 1.16 m.
  EXPECT_NEAR(entries[0].depth_m, 1.69 + 0.064 * (3.0 - 1.16) / 2.42 - 1.58, 1e-3);
  wall.distance_m = 1.57 + kPost_m;
  world.structures = {wall};
  EXPECT_TRUE(EntriesOf(world).at(0).is_in_way);
  wall.distance_m = 1.76 + kPost_m;
  world.structures = {wall};
  EXPECT_TRUE(EntriesOf(world).empty());
}

TEST(GaugeEntries, AreOfTheSpaceThatTheWorldWantsClear) {
  WorldSpec world = CurveOfTwoTracks();
  world.tracks.pop_back();
  world.objects = {BoxAt(150.0, -2.9, {0.5, 1.0, 1.0})};
  EXPECT_TRUE(EntriesOf(world).empty());
  world.clear_space = {{0.0, 2.5}, {5.0, 2.5}};
  const std::vector<GaugeEntry> entries = EntriesOf(world);
  ASSERT_EQ(entries.size(), 1U);
  // The curve of 400 m wants 9 mm more; the box's ends are 0.25^2 / 800 m farther away.
  EXPECT_NEAR(entries[0].depth_m, 2.5 + 3.75 / 400.0 - 2.4, 1e-3);
}

TEST(GaugeEntries, WantMoreRoomBesideCantedTrack) {
  WorldSpec world = CurveOfTwoTracks();
  world.tracks.pop_back();
  NoiseWallSpec wall;
  wall.name = "wall";
  wall.side = TrackSide::kLeft;
  wall.begin_s_m = 20.0;
  wall.end_s_m = 290.0;
  wall.height_m = 3.0;
  wall.distance_m = 2.1 + kPost_m;
  world.structures = {wall};
  EXPECT_TRUE(EntriesOf(world).empty());
  world.alignment.cants_mm = {{0.0, 150.0}};
  const std::vector<GaugeEntry> entries = EntriesOf(world);
  ASSERT_EQ(entries.size(), 1U);
  EXPECT_FALSE(entries[0].is_in_way);
  // Seen from a track that leans by asin(0.1) towards it, the wall's top is 1.790 m aside and 3.195
  // m up. There the clear space is 1.744 m wide, 9 mm more in the curve, and 72 mm more since
  // vehicles lean out: 0.4 x 0.1 m x 2.695 m / 1.5 m.
  EXPECT_NEAR(entries[0].depth_m, 1.744 + 0.009 + 0.072 - 1.790, 3e-3);
}

TEST(GaugeEntries, HoldABoxAcrossBothTracks) {
  WorldSpec world = CurveOfTwoTracks();
  world.objects = {BoxAt(150.0, 2.0, {1.0, 12.0, 0.5})};
  const std::vector<GaugeEntry> entries = EntriesOf(world);
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries[1].track, "second");
  // Of 1.656 m at 0.39 m and 1.665 m at 1.16 m, at the box's top, and in a curve of 396 m.
  EXPECT_NEAR(entries[1].depth_m, 1.656 + 0.009 * 0.11 / 0.77 + 3.75 / 396.0, 1e-4);
}

TEST(GaugeEntries, HoldADeckThatIsTooLow) {
  WorldSpec world = CurveOfTwoTracks();
  OverbridgeSpec bridge;
  bridge.name = "road bridge";
  bridge.begin_s_m = 100.0;
  bridge.end_s_m = 110.0;
  bridge.clearance_m = 4.0;
  world.structures = {bridge};
  const std::vector<GaugeEntry> entries = EntriesOf(world);
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_NEAR(entries[0].bottom_m, 4.0, 1e-3);
  EXPECT_NEAR(entries[0].depth_m, 1.575, 1e-3);
}

TEST(GaugeEntries, LeaveOutWhatBelongsToTheTrackAndWhatStandsClear) {
  WorldSpec world = CurveOfTwoTracks();
  ThirdRailSpec rail;
  rail.name = "third rail";
  rail.side = TrackSide::kRight;
  rail.begin_s_m = 10.0;
  rail.end_s_m = 290.0;
  SlabTrackSpec slab;
  slab.name = "slab";
  slab.begin_s_m = 10.0;
  slab.end_s_m = 90.0;
  TunnelSpec tunnel;
  tunnel.name = "tunnel";
  tunnel.begin_s_m = 100.0;
  tunnel.end_s_m = 180.0;
  BridgeSpec bridge;
  bridge.name = "bridge";
  bridge.begin_s_m = 200.0;
  bridge.end_s_m = 230.0;
  world.structures = {rail, slab, tunnel, bridge};
  EXPECT_TRUE(EntriesOf(world).empty());
}

TEST(GaugeEntries, HoldAWagonFoulOfAnotherTrackButNotOnItsOwn) {
  WorldSpec world = CurveOfTwoTracks();
  ObjectSpec wagon;
  wagon.name = "wagon";
  wagon.type = TypeNamed("open_wagon");
  wagon.s_m = 150.0;
  world.objects = {wagon};
  EXPECT_TRUE(EntriesOf(world).empty());
  world.objects[0].d_m = 1.5;
  const std::vector<GaugeEntry> entries = EntriesOf(world);
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries[1].track, "second");
}

TEST(GaugeEntries, AreReportedInALineEach) {
  EXPECT_EQ(GaugeText({}), "");
  const GaugeEntry entry{.name = "west",
                         .track = "main",
                         .begin_s_m = 81.24,
                         .end_s_m = 218.76,
                         .stretches = {},
                         .deepest_s_m = 150.0,
                         .depth_m = 0.0754,
                         .bottom_m = 0.0,
                         .top_m = 0.76};
  GaugeEntry in_way = entry;
  in_way.is_in_way = true;
  const std::string where =
      " track \"main\" at s 81.2 to 218.8 m, deepest at 150.0 m by 0.08 m, from 0.00 to 0.76 m "
      "above top of rail\n";
  EXPECT_EQ(GaugeText({entry, in_way}), "clearance \"west\" is in the clear space of" + where +
                                            "          \"west\" is in the way on" + where);
}

TEST(GaugeEntries, SayBetweenWhichChainagesAThingReachesIn) {
  // Of some 1.7 m half width, the clear space of a track 4.5 m away has a wall at 3.8 m, and that
  // of one 8 m away does not.
  WorldSpec world = CurveOfTwoTracks();
  world.tracks[1].offset_m.reset();
  world.tracks[1].offsets_m = {{60.0, 8.0},  {90.0, 4.5},  {120.0, 4.5}, {150.0, 8.0},
                               {180.0, 8.0}, {210.0, 4.5}, {240.0, 4.5}, {270.0, 8.0}};
  NoiseWallSpec wall;
  wall.name = "wall";
  wall.side = TrackSide::kLeft;
  wall.begin_s_m = 20.0;
  wall.end_s_m = 290.0;
  wall.distance_m = 3.8;
  world.structures = {wall};
  const std::vector<GaugeEntry> entries = EntriesOf(world);
  ASSERT_EQ(entries.size(), 1U);
  ASSERT_EQ(entries[0].stretches.size(), 2U);
  EXPECT_EQ(entries[0].stretches[0].begin_s_m, entries[0].begin_s_m);
  EXPECT_EQ(entries[0].stretches[1].end_s_m, entries[0].end_s_m);
  for (const int i : {0, 1}) {
    EXPECT_NEAR(entries[0].stretches[static_cast<std::size_t>(i)].begin_s_m, 76.0 + 120.0 * i, 8.0);
    EXPECT_NEAR(entries[0].stretches[static_cast<std::size_t>(i)].end_s_m, 134.0 + 120.0 * i, 8.0);
  }
}

/// A line of curves, each 500 m with a siding of its own, a platform at it and a bridge.
WorldSpec LineOfSidings(int num_sidings) {
  WorldSpec world;
  AlignmentElementsSpec course;
  for (int i = 0; i < num_sidings; ++i) {
    const double begin_s_m = 500.0 * i;
    course.elements.push_back({ElementType::kArc, 460.0, i % 2 == 0 ? 600.0 : -600.0});
    course.elements.push_back({ElementType::kClothoid, 40.0, {}});
    const std::string name = "siding_" + std::to_string(i);
    TrackSpec siding{.name = name, .offset_m = 4.5, .end_s_m = begin_s_m + 400.0};
    siding.start_s_m = begin_s_m + 100.0;
    world.tracks.push_back(siding);
    PlatformSpec platform = PlatformAt(i == 1 ? 1.5 : 1.65);
    platform.name = "platform_" + std::to_string(i);
    platform.begin_s_m = begin_s_m + 150.0;
    platform.end_s_m = begin_s_m + 350.0;
    world.structures.emplace_back(platform);
    BridgeSpec bridge;
    bridge.name = "bridge_" + std::to_string(i);
    bridge.begin_s_m = begin_s_m + 200.0;
    bridge.end_s_m = begin_s_m + 300.0;
    world.structures.emplace_back(bridge);
  }
  course.elements.push_back({ElementType::kArc, 100.0, 600.0});
  world.alignment.course = course;
  return world;
}

StructuresInGauge InGaugeOfSidings(int num_sidings) {
  const WorldSpec world = LineOfSidings(num_sidings);
  const Alignment alignment(world.alignment);
  return FindStructuresInGauge(world, alignment, MakeNetwork(world, alignment.length_m()).courses);
}

TEST(GaugeEntries, CostTwiceAsMuchForTwiceTheLine) {
  const StructuresInGauge once = InGaugeOfSidings(6);
  const StructuresInGauge twice = InGaugeOfSidings(12);
  // Were each structure compared with each track, it would be four times.
  EXPECT_NEAR(
      static_cast<double>(twice.num_comparisons) / static_cast<double>(once.num_comparisons), 2.0,
      0.05);
  ASSERT_EQ(once.entries.size(), 1U);
  EXPECT_EQ(once.entries[0].name, "platform_1");
  EXPECT_EQ(twice.entries.size(), 1U);
}

/// Of a track 20 m beside a bridge in a curve, no triangle of the bridge is divided.
TEST(GaugeEntries, CompareAnArcOfTheLineWithWhatIsBesideItByItsSagitta) {
  WorldSpec world = LineOfSidings(1);
  world.tracks.push_back({.name = "aside", .offset_m = 25.0, .end_s_m = {}});
  const Alignment alignment(world.alignment);
  const auto comparisons = [&] {
    const Network network = MakeNetwork(world, alignment.length_m());
    return FindStructuresInGauge(world, alignment, network.courses).num_comparisons;
  };
  const std::size_t with_it = comparisons();
  world.tracks.pop_back();
  EXPECT_EQ(with_it, comparisons());
}

}  // namespace
}  // namespace railcast
