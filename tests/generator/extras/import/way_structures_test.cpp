#include "generator/extras/import/structures/line_structures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "generator/extras/import/structures/standing_world.h"
#include "tests/generator/extras/import/made_map.h"

namespace railcast {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const MapTags kInTunnel = {{"tunnel", "yes"}};
const MapTags kOnBridge = {{"bridge", "yes"}};

/// Chainages of points on a straight are fitted to 0.1 m and written in centimetres.
constexpr double kOff_m = 0.2;

/// Matches MadeMap::PlacesOf_x_m().
auto RunsFrom_x_m(double begin_x_m, double end_x_m) {
  return ElementsAre(DoubleNear(begin_x_m, kOff_m), DoubleNear(end_x_m, kOff_m));
}

TEST(WayStructures, TracksBesideEachOtherShareATunnel) {
  MadeMap map = ImportedTracks({{0.0, kInTunnel}, {4.5, kInTunnel}});
  const TunnelSpec tunnel = map.Only<TunnelSpec>();
  EXPECT_EQ(tunnel.track, "main");
  EXPECT_THAT(map.PlacesOf_x_m(tunnel), RunsFrom_x_m(800.0, 1200.0));
  EXPECT_THAT(map.ReasonsFor("tunnel"), IsEmpty());
}

TEST(WayStructures, ATunnelIsAboutTheTrackThatHasIt) {
  MadeMap map = ImportedTracks({{0.0, {}}, {12.0, kInTunnel}});
  const TunnelSpec tunnel = map.Only<TunnelSpec>();
  EXPECT_EQ(tunnel.track, "running_1");
  EXPECT_THAT(map.PlacesOf_x_m(tunnel), RunsFrom_x_m(800.0, 1200.0));
}

TEST(WayStructures, ATunnelOfTheLineTakesInATrackThatHasNoneOnTheMap) {
  MadeMap map = ImportedTracks({{0.0, kInTunnel}, {4.5, {}}});
  const TunnelSpec tunnel = map.Only<TunnelSpec>();
  EXPECT_THAT(map.PlacesOf_x_m(tunnel), RunsFrom_x_m(800.0, 1200.0));
}

TEST(WayStructures, ThereIsNoTunnelInWhichTheLineWouldRunThoughItIsOutside) {
  MadeMap map = ImportedTracks({{0.0, {}}, {4.5, kInTunnel}});
  EXPECT_THAT(map.All<TunnelSpec>(), IsEmpty());
  EXPECT_THAT(map.ReasonsFor("tunnel"),
              ElementsAre("track main, which has none on the map, would run in it"));
  const AccountRow tunnels = map.Sum("tunnel");
  EXPECT_NEAR(tunnels.on_map, 400.0, 1.0);
  EXPECT_EQ(tunnels.in_worlds, 0.0);
}

/// At 7.4 m, tracks in one row become tracks in two. That is within the tunnel here, some
/// millimetres before, at or behind a whole metre.
TEST(WayStructures, TracksThatComeNearerThanTwoLiningsNeedLoseNoTunnel) {
  for (double end_y_m = 6.0; end_y_m < 6.025; end_y_m += 0.01) {
    MadeMap map{{0.0, kInTunnel}};
    map.AddWay({{100.0, 20.0 + end_y_m}, {450.0, 13.0 + end_y_m}, {800.0, 6.0 + end_y_m}}, {});
    map.AddWay({{800.0, 6.0 + end_y_m}, {1000.0, 2.0 + end_y_m}, {1100.0, end_y_m}}, kInTunnel);
    map.AddWay({{1100.0, end_y_m}, {1600.0, end_y_m}, {1900.0, end_y_m}}, {});
    map.Make();
    ClearStructures(map.line().alignment, map.world());
    EXPECT_THAT(map.ReasonsFor("tunnel"), IsEmpty()) << end_y_m;
    EXPECT_NEAR(map.Sum("tunnel").in_worlds, 700.0, 10.0) << end_y_m;
  }
}

/// Two linings for one track each are 11.2 m wide under a contact line, and the gauge of the other
/// track is 1.575 m wide.
TEST(WayStructures, TracksTooNearForTwoLiningsShareOne) {
  for (const auto& [y_m, num_tunnels] : {std::pair(6.5, 1), {7.1, 1}, {7.5, 2}, {10.0, 2}}) {
    MadeMap map = ImportedTracks({{0.0, kInTunnel}, {y_m, kInTunnel}});
    ClearStructures(map.line().alignment, map.world());
    EXPECT_THAT(map.All<TunnelSpec>(), SizeIs(num_tunnels)) << y_m;
    const AccountRow tunnels = map.Sum("tunnel");
    EXPECT_NEAR(tunnels.on_map, 800.0, 1.0) << y_m;
    EXPECT_NEAR(tunnels.in_worlds, 800.0, 1.0) << y_m;
  }
}

/// Tracks that part in a tunnel, from 4.5 m to 24.5 m at 1:15, pass all distances.
TEST(WayStructures, NothingOfATunnelIsLostWhereItsTracksPart) {
  MadeMap map{{0.0, kInTunnel}};
  map.AddWay({{100.0, 4.5}, {400.0, 4.5}, {800.0, 4.5}}, {});
  map.AddWay({{800.0, 4.5},
              {860.0, 4.5},
              {900.0, 4.9},
              {960.0, 8.5},
              {1020.0, 12.5},
              {1080.0, 16.5},
              {1140.0, 20.1},
              {1200.0, 22.5}},
             kInTunnel);
  map.AddWay({{1200.0, 22.5}, {1260.0, 24.0}, {1320.0, 24.5}, {1600.0, 24.5}, {1900.0, 24.5}}, {});
  map.Make();
  ClearStructures(map.line().alignment, map.world());
  EXPECT_THAT(map.ReasonsFor("tunnel"), IsEmpty());
  const AccountRow tunnels = map.Sum("tunnel");
  EXPECT_NEAR(tunnels.on_map, 800.0, 2.0);
  EXPECT_NEAR(tunnels.in_worlds, tunnels.on_map, 2.0);
  // One about both, and one about each where they have parted.
  ASSERT_THAT(map.All<TunnelSpec>(), SizeIs(3));
  double shared_end_s_m = 0.0;
  for (const TunnelSpec& tunnel : map.All<TunnelSpec>()) {
    const double s_m = map.runs_east() ? tunnel.begin_s_m : tunnel.end_s_m;
    if (std::abs(s_m - map.ChainageAt_m(800.0)) < 1.0) {
      shared_end_s_m = map.runs_east() ? tunnel.end_s_m : tunnel.begin_s_m;
    }
  }
  EXPECT_NEAR(shared_end_s_m, map.ChainageAt_m(935.0), 25.0);
  for (const TunnelSpec& tunnel : map.All<TunnelSpec>()) {
    const bool goes_on = tunnel.begin_s_m == shared_end_s_m || tunnel.end_s_m == shared_end_s_m;
    EXPECT_TRUE(goes_on) << tunnel.name;
  }
}

/// A loop of 200 m makes only its own stretch of the line's tunnel wide.
TEST(WayStructures, ATunnelIsWideOnlyWhereItsTracksNeedIt) {
  MadeMap map{{0.0, kInTunnel}};
  map.AddWay({{1000.0, 6.5}, {1100.0, 6.5}, {1200.0, 6.5}}, kInTunnel);
  map.Make();
  const std::vector<TunnelSpec> tunnels = map.All<TunnelSpec>();
  ASSERT_THAT(tunnels, SizeIs(2));
  EXPECT_EQ(tunnels[0].end_s_m, tunnels[1].begin_s_m);
  EXPECT_NEAR(tunnels[0].end_s_m, map.ChainageAt_m(1000.0), 1.0);
  EXPECT_NEAR(map.Sum("tunnel").in_worlds, 600.0, 1.0);
}

TEST(WayStructures, ABridgeCarriesTracksBesideEachOtherAndTheRestHaveTheirOwn) {
  MadeMap map =
      ImportedTracks({{0.0, kOnBridge}, {4.5, kOnBridge}, {20.0, kOnBridge}, {24.5, kOnBridge}});
  const std::vector<BridgeSpec> bridges = map.All<BridgeSpec>();
  ASSERT_THAT(bridges, SizeIs(2));
  EXPECT_EQ(bridges[0].track, "main");
  EXPECT_EQ(bridges[0].name, "bridge_1");
  EXPECT_NE(bridges[1].track, "main");
  EXPECT_EQ(bridges[1].name, "bridge_2");
}

TEST(WayStructures, WhatATrackHasBeyondASharedBridgeIsItsOwn) {
  MadeMap map{{0.0, kOnBridge}};
  map.AddWay({{500.0, 4.5}, {600.0, 4.5}, {900.0, 4.5}}, kOnBridge);
  map.AddWay({{900.0, 4.5}, {1200.0, 4.5}, {1500.0, 4.5}}, {});
  map.Make();
  const std::vector<BridgeSpec> bridges = map.All<BridgeSpec>();
  ASSERT_THAT(bridges, SizeIs(2));
  EXPECT_EQ(bridges[1].track, "running_1");
  EXPECT_THAT(map.PlacesOf_x_m(bridges[1]),
              ElementsAre(DoubleNear(500.0, kOff_m), DoubleNear(800.0, 1.0 + kOff_m)));
}

TEST(WayStructures, TramsAndUndergroundsInTunnelsHaveNoBallast) {
  for (const auto& [tags, is_slab] : {std::pair<MapTags, bool>{{{"railway", "tram"}}, true},
                                      {{{"railway", "subway"}, {"tunnel", "yes"}}, true},
                                      {{{"railway", "subway"}}, false},
                                      {{{"railway", "tram"}, {"railway:ballastless", "no"}}, false},
                                      {{{"railway", "rail"}, {"tunnel", "yes"}}, false}}) {
    MadeMap map = ImportedTracks({{0.0, tags}});
    EXPECT_THAT(map.All<SlabTrackSpec>(), SizeIs(is_slab ? 1 : 0));
  }
}

TEST(WayStructures, ThirdRailMayStandBesideAContactLine) {
  MadeMap map = ImportedTracks({{0.0, {{"electrified", "contact_line;rail"}}}});
  EXPECT_THAT(map.All<ThirdRailSpec>(), SizeIs(1));
}

TEST(WayStructures, SlabTrackAndThirdRailBelongToTheirTrack) {
  MadeMap map =
      ImportedTracks({{0.0, {}}, {4.5, {{"railway:ballastless", "yes"}, {"electrified", "rail"}}}});
  ASSERT_THAT(map.All<SlabTrackSpec>(), SizeIs(1));
  EXPECT_EQ(map.All<SlabTrackSpec>()[0].track, "running_1");
  ASSERT_THAT(map.All<ThirdRailSpec>(), SizeIs(1));
  EXPECT_EQ(map.All<ThirdRailSpec>()[0].track, "running_1");
}

}  // namespace
}  // namespace railcast
