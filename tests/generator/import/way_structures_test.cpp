#include "generator/import/structures/way_structures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/generator/import/made_map.h"

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

TEST(WayStructures, TracksBesideEachOtherShareATunnel) {
  MadeMap map;
  map.AddTrack(0.0, kInTunnel);
  map.AddTrack(4.5, kInTunnel);
  map.Make();
  const std::vector<TunnelSpec> tunnels = map.All<TunnelSpec>();
  ASSERT_THAT(tunnels, SizeIs(1));
  EXPECT_EQ(tunnels[0].track, "main");
  EXPECT_THAT(map.PlacesOf_x_m(tunnels[0]),
              ElementsAre(DoubleNear(800.0, kOff_m), DoubleNear(1200.0, kOff_m)));
  EXPECT_THAT(map.ReasonsFor("tunnel"), IsEmpty());
}

TEST(WayStructures, ATunnelIsAboutTheTrackThatHasIt) {
  MadeMap map;
  map.AddTrack(0.0, {});
  map.AddTrack(12.0, kInTunnel);
  map.Make();
  const std::vector<TunnelSpec> tunnels = map.All<TunnelSpec>();
  ASSERT_THAT(tunnels, SizeIs(1));
  EXPECT_EQ(tunnels[0].track, "running_1");
  EXPECT_THAT(map.PlacesOf_x_m(tunnels[0]),
              ElementsAre(DoubleNear(800.0, kOff_m), DoubleNear(1200.0, kOff_m)));
}

TEST(WayStructures, ThereIsNoTunnelWhereATrackOutsideWouldRunInIt) {
  MadeMap map;
  map.AddTrack(0.0, kInTunnel);
  map.AddTrack(4.5, {});
  map.Make();
  EXPECT_THAT(map.All<TunnelSpec>(), IsEmpty());
  EXPECT_THAT(
      map.ReasonsFor("tunnel"),
      ElementsAre("track running_1, which has none on the map, would run in it up to 1200 m"));
}

TEST(WayStructures, ATunnelIsCutWhereATrackOutsideBegins) {
  MadeMap map;
  map.AddTrack(0.0, kInTunnel);
  map.AddWay({{1000.0, 4.5}, {1400.0, 4.5}, {1800.0, 4.5}}, {});
  map.Make();
  const std::vector<TunnelSpec> tunnels = map.All<TunnelSpec>();
  ASSERT_THAT(tunnels, SizeIs(1));
  // Cut at whole metres.
  EXPECT_THAT(map.PlacesOf_x_m(tunnels[0]),
              ElementsAre(DoubleNear(800.0, kOff_m), DoubleNear(1000.0, 1.0 + kOff_m)));
  EXPECT_THAT(map.ReasonsFor("tunnel"), SizeIs(1));
}

TEST(WayStructures, ABridgeCarriesTracksBesideEachOtherAndTheRestHaveTheirOwn) {
  MadeMap map;
  map.AddTrack(0.0, kOnBridge);
  map.AddTrack(4.5, kOnBridge);
  map.AddTrack(20.0, kOnBridge);
  map.AddTrack(24.5, kOnBridge);
  map.Make();
  const std::vector<BridgeSpec> bridges = map.All<BridgeSpec>();
  ASSERT_THAT(bridges, SizeIs(2));
  EXPECT_EQ(bridges[0].track, "main");
  EXPECT_EQ(bridges[0].name, "bridge_1");
  EXPECT_NE(bridges[1].track, "main");
  EXPECT_EQ(bridges[1].name, "bridge_2");
}

TEST(WayStructures, WhatATrackHasBeyondASharedBridgeIsItsOwn) {
  MadeMap map;
  map.AddTrack(0.0, kOnBridge);
  map.AddWay({{500.0, 4.5}, {600.0, 4.5}, {900.0, 4.5}}, kOnBridge);
  map.AddWay({{900.0, 4.5}, {1200.0, 4.5}, {1500.0, 4.5}}, {});
  map.Make();
  const std::vector<BridgeSpec> bridges = map.All<BridgeSpec>();
  ASSERT_THAT(bridges, SizeIs(2));
  EXPECT_EQ(bridges[1].track, "running_1");
  EXPECT_THAT(map.PlacesOf_x_m(bridges[1]),
              ElementsAre(DoubleNear(500.0, kOff_m), DoubleNear(800.0, 1.0 + kOff_m)));
}

TEST(WayStructures, SlabTrackAndThirdRailBelongToTheirTrack) {
  MadeMap map;
  map.AddTrack(0.0, {});
  map.AddTrack(4.5, {{"railway:ballastless", "yes"}, {"electrified", "rail"}});
  map.Make();
  ASSERT_THAT(map.All<SlabTrackSpec>(), SizeIs(1));
  EXPECT_EQ(map.All<SlabTrackSpec>()[0].track, "running_1");
  ASSERT_THAT(map.All<ThirdRailSpec>(), SizeIs(1));
  EXPECT_EQ(map.All<ThirdRailSpec>()[0].track, "running_1");
}

}  // namespace
}  // namespace railcast
