#include "generator/extras/import/structures/line_structures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/generator/extras/import/made_map.h"

namespace railcast {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Tracks are fitted to 0.1 m.
constexpr double kPlatformOff_m = 0.2;

PlatformSpec Of(const std::string& track, const MadeMap& map) {
  for (const PlatformSpec& platform : map.All<PlatformSpec>()) {
    if (platform.track == track) return platform;
  }
  ADD_FAILURE() << "no platform at " << track;
  return {};
}

TEST(Platforms, AnIslandHasAnEdgeAtBothTracks) {
  MadeMap map{{0.0, {}}, {10.0, {}}};
  map.AddPlatformArea(900.0, 1100.0, 2.2, 7.6);
  map.Make();
  ASSERT_THAT(map.All<PlatformSpec>(), SizeIs(2));
  EXPECT_EQ(Of("main", map).side, map.north());
  EXPECT_EQ(Of("running_1", map).side, map.south());
  for (const PlatformSpec& platform : map.All<PlatformSpec>()) {
    EXPECT_THAT(map.PlacesOf_x_m(platform),
                ElementsAre(DoubleNear(900.0, kPlatformOff_m), DoubleNear(1100.0, kPlatformOff_m)));
    EXPECT_EQ(platform.edge_distance_m, 1.65);
    EXPECT_NEAR(platform.width_m, 0.5 * (10.0 - 2.0 * 1.65), kPlatformOff_m) << "they touch";
  }
}

TEST(Platforms, BelongToTheTrackThatTheyRunAlong) {
  MadeMap map{{0.0, {}}, {4.5, {}}};
  map.AddPlatformArea(900.0, 1100.0, 6.5, 9.0);
  map.Make();
  const PlatformSpec platform = map.Only<PlatformSpec>();
  EXPECT_EQ(platform.track, "running_1");
  EXPECT_EQ(platform.side, map.north());
  EXPECT_NEAR(platform.width_m, 2.5, kPlatformOff_m);
}

TEST(Platforms, OfPublicTransportAreTakenButNotThoseOfBuses) {
  MadeMap map{{0.0, {}}};
  map.AddThing({{500.0, 2.0}, {600.0, 2.0}}, {{"public_transport", "platform"}});
  map.AddThing({{700.0, 2.0}, {800.0, 2.0}}, {{"public_transport", "platform"}, {"bus", "yes"}});
  map.Make();
  const PlatformSpec platform = map.Only<PlatformSpec>();
  EXPECT_THAT(map.PlacesOf_x_m(platform),
              ElementsAre(DoubleNear(500.0, kPlatformOff_m), DoubleNear(600.0, kPlatformOff_m)));
  EXPECT_EQ(platform.width_m, PlatformSpec{}.width_m) << "a line does not tell";
}

TEST(Platforms, StandWhereTheFitIsFarFromTheMapToo) {
  MadeMap map{{0.0, {}}};
  map.AddWay({{100.0, 2.2}, {500.0, 2.2}, {1900.0, 2.2}}, {});  // Moved to 3.25 m.
  map.AddPlatformArea(900.0, 1100.0, 3.9, 6.0);
  map.Make();
  EXPECT_EQ(Of("running_1", map).side, map.north());
  const std::vector<MovedTrack> moved = MovedTracksOf(map.world());
  ASSERT_THAT(moved, SizeIs(1));
  EXPECT_NEAR(moved[0].end_s_m - moved[0].begin_s_m, 1800.0, 1.0);
  EXPECT_NEAR(moved[0].most_m, 3.25 - 2.2, kPlatformOff_m);
}

TEST(Platforms, FollowTheWidthOfTheirOutline) {
  MadeMap map{{0.0, {}}};
  map.AddThing({{900.0, 2.0}, {1100.0, 2.0}, {1100.0, 8.0}, {900.0, 4.0}, {900.0, 2.0}},
               {{"railway", "platform"}});
  map.Make();
  const std::vector<PlatformSpec> platforms = map.All<PlatformSpec>();
  // It widens by 0.5 m in 25 m.
  ASSERT_THAT(platforms, SizeIs(8));
  for (const PlatformSpec& platform : platforms) {
    const std::vector<double> ends_m = map.PlacesOf_x_m(platform);
    const double middle_m = 0.5 * (ends_m[0] + ends_m[1]);
    EXPECT_NEAR(platform.width_m, 2.0 + 0.02 * (middle_m - 900.0), 0.05) << middle_m;
  }
}

TEST(Platforms, ThatLieAcrossATrackSayAcrossWhich) {
  MadeMap map{{0.0, {}}, {4.5, {}}};
  map.AddPlatformArea(900.0, 1100.0, 2.0, 7.0);
  map.Make();
  EXPECT_THAT(map.All<PlatformSpec>(), IsEmpty());
  EXPECT_THAT(map.ReasonsFor("platform"), ElementsAre("it lies across track running_1 on the map"));
}

TEST(Platforms, WithoutATrackOrRoomOrWhereAnotherIsAreLeftOut) {
  MadeMap map{{0.0, {}}, {10.0, {}}};
  map.AddPlatformArea(300.0, 400.0, 30.0, 33.0);
  map.AddPlatformArea(500.0, 600.0, -2.3, -2.0);
  map.AddPlatformArea(700.0, 800.0, -5.0, -2.0);
  map.AddPlatformArea(750.0, 850.0, -5.0, -2.0);
  map.Make();
  EXPECT_THAT(map.All<PlatformSpec>(), SizeIs(1));
  EXPECT_THAT(map.ReasonsFor("platform"),
              ElementsAre("no track of the world runs along it",
                          "there is no room for it beside track main",
                          "another one stands on its side of track main"));
}

}  // namespace
}  // namespace railcast
