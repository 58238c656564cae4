#include "generator/extras/import/structures/standing_world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "tests/generator/extras/import/made_map.h"

namespace railcast {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

WorldTrack TrackBeside(const std::string& name, double offset_m) {
  WorldTrack track{{{}, TrackCourse(100.0, 900.0, offset_m), {}, {}, 0}, {}};
  track.draft.spec.name = name;
  track.draft.spec.offset_m = offset_m;
  track.draft.spec.start_s_m = 100.0;
  track.draft.spec.end_s_m = 900.0;
  return track;
}

TEST(StandingWorld, IsLeftAsItIsIfCheckHasNothingAgainstIt) {
  MadeMap map;
  map.AddTrack(0.0, {{"tunnel", "yes"}});
  map.AddTrack(4.5, {});
  map.Make();
  EXPECT_EQ(MakeStand(map.line().alignment, std::nullopt, map.world()), std::nullopt);
  EXPECT_EQ(map.world().tracks.size(), 2U);
  EXPECT_THAT(map.All<TunnelSpec>(), SizeIs(1));
  EXPECT_THAT(map.world().left_out, IsEmpty());
}

TEST(StandingWorld, LosesTheTracksThatCheckRefusesWithAllThatStandsOnThem) {
  MadeMap map;
  map.AddTrack(0.0, {});
  map.Make();
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
  MadeMap map;
  map.AddTrack(0.0, {});
  map.Make();
  AlignmentSpec alignment = map.line().alignment;
  alignment.speed_limits_kmph = {{0.0, -1.0}};
  const auto fault = MakeStand(alignment, std::nullopt, map.world());
  ASSERT_TRUE(fault);
  EXPECT_THAT(*fault, ::testing::HasSubstr("/world/alignment/speed_limits_kmph"));
}

}  // namespace
}  // namespace railcast
