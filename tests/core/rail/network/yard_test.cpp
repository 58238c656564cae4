#include "core/rail/network/network_draft.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/rail/network/turnout_place.h"
#include "core/rail/world/world_draft.h"
#include "tests/core/rail/test_line.h"
#include "tests/core/rail/test_tables.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kSpacingError_m = 1e-6;

WorldSpec LineWithAYard(TurnoutType type, double spacing_m, std::uint32_t num_tracks) {
  WorldSpec world = StraightLine(1000.0);
  YardSpec yard{.name = "yard",
                .begin = TurnoutSpec{"main", 100.0, type, TrackSide::kRight, {}},
                .num_tracks = num_tracks,
                .spacing_m = spacing_m,
                .usable_length_m = 120.0};
  world.yards.push_back(yard);
  return world;
}

TEST(Yard, LaysParallelTracksAtItsSpacing) {
  for (const TurnoutType type : kTurnoutTypes) {
    const WorldSpec world = WithTracksOfYards(LineWithAYard(type, 5.0, 4));
    const Network network = MakeNetwork(world, 1000.0);
    ASSERT_EQ(network.courses.size(), 5U);
    for (std::size_t k = 1; k <= 4; ++k) {
      // The lead comes first and is the last of the yard's tracks.
      const TrackCourse& track = network.courses[k == 4 ? 1 : k + 1];
      const TrackOffset end = track.OffsetAt(track.end_s_m());
      EXPECT_NEAR(end.d_m, -5.0 * static_cast<double>(k), kSpacingError_m);
      EXPECT_NEAR(end.slope, 0.0, 1e-12);
    }
  }
}

TEST(Yard, GivesItsTracksTheirUsableLengthBehindTheFoulingPoint) {
  const WorldSpec world = WithTracksOfYards(LineWithAYard(TurnoutType::k9_190, 4.5, 3));
  const Network network = MakeNetwork(world, 1000.0);
  ASSERT_EQ(network.turnouts.size(), 3U);
  for (const TurnoutSite& turnout : network.turnouts) {
    if (turnout.branch == 1) continue;
    ASSERT_TRUE(turnout.fouling_s_m.has_value());
    EXPECT_NEAR(network.courses[turnout.branch].end_s_m() - *turnout.fouling_s_m, 120.0, 1e-4);
    const double apart_m = network.courses[turnout.branch].OffsetAt(*turnout.fouling_s_m).d_m -
                           network.courses[turnout.track].OffsetAt(*turnout.fouling_s_m).d_m;
    EXPECT_NEAR(std::abs(apart_m), kFoulingDistance_m, kSpacingError_m);
  }
  // The lead shares its last fouling point with the track beside it.
  const TurnoutSite& last = network.turnouts.back();
  EXPECT_NEAR(network.courses[1].end_s_m() - *last.fouling_s_m, 120.0, 1e-4);
}

TEST(Yard, KeepsItsTracksApart) {
  const WorldSpec world = WithTracksOfYards(LineWithAYard(TurnoutType::k9_190, 4.5, 5));
  WorldFaults faults;
  const NetworkDraft network = DraftNetwork(world, 1000.0, faults);
  CheckNetwork(world, network, Alignment(world.alignment), faults);
  EXPECT_THAT(faults.errors.lines(), testing::IsEmpty());
}

std::vector<std::string> FaultsOfYard(const WorldSpec& world) {
  WorldFaults faults;
  static_cast<void>(DraftWorld({world, {}, RailLabels(), RailMaterials()}, faults));
  return faults.errors.lines();
}

TEST(Yard, ReportsItsOwnFaults) {
  WorldSpec world = LineWithAYard(TurnoutType::k12_500, 3.2, 3);
  world.yards[0].begin.side.reset();
  EXPECT_THAT(
      FaultsOfYard(world),
      ElementsAre("/world/yards/0/begin: must have a side",
                  "/world/yards/0/spacing_m: must be at least 3.5 m, for fouling points and "
                  "for turnouts 1:12-500 to follow each other in the lead (got 3.2)"));
}

TEST(Yard, ReportsFaultsOfItsTracks) {
  WorldSpec world = LineWithAYard(TurnoutType::k9_190, 4.5, 3);
  world.yards[0].begin.track = "mian";
  EXPECT_THAT(FaultsOfYard(world),
              ElementsAre(testing::StartsWith("/world/yards/0: track \"yard_lead\" must be one of "
                                              "\"main\", ")));
  world = LineWithAYard(TurnoutType::k9_190, 4.5, 3);
  world.yards[0].usable_length_m = 2000.0;
  EXPECT_THAT(FaultsOfYard(world),
              testing::Contains(testing::StartsWith(
                  "/world/yards/0: track \"yard_lead\" must lie on the line, from 0 to 1000 m")));
}

std::vector<std::string> FaultsOfNetwork(const WorldSpec& world) {
  WorldFaults faults;
  const Alignment alignment(world.alignment);
  const NetworkDraft network = DraftNetwork(world, alignment.length_m(), faults);
  CheckNetwork(world, network, alignment, faults);
  return faults.errors.lines();
}

TrackSpec Branch(const std::string& name, double offset_m, double s_m) {
  return {.name = name,
          .offset_m = offset_m,
          .begin = TurnoutSpec{"main", s_m, TurnoutType::k9_190, {}, {}}};
}

TEST(CheckNetwork, LetsTracksBeCloseWhereATurnoutJoinsThem) {
  WorldSpec world = StraightLine(1000.0);
  world.tracks.push_back(Branch("left", 4.5, 300.0));
  world.tracks.push_back(Branch("right", -4.5, 330.0));
  world.tracks.push_back({.name = "crossover",
                          .begin = TurnoutSpec{"main", 500.0, TurnoutType::k9_190, {}, {}},
                          .end = TurnoutSpec{"left", {}, TurnoutType::k9_190, {}, {}}});
  EXPECT_THAT(FaultsOfNetwork(world), IsEmpty());
}

TEST(CheckNetwork, ReportsTracksThatAreTooCloseBehindTheirTurnouts) {
  WorldSpec world = StraightLine(1000.0);
  world.tracks.push_back(Branch("left", 4.5, 300.0));
  world.tracks.push_back({.name = "other", .offset_m = 6.5});
  EXPECT_THAT(FaultsOfNetwork(world),
              ElementsAre("/world/tracks/2: must be at least 3 m from track \"left\" where no "
                          "turnout joins them (got 2 m at 361.546 m)"));
}

TEST(CheckNetwork, ReportsTracksThatCross) {
  WorldSpec world = StraightLine(1000.0);
  world.tracks.push_back({.name = "across",
                          .offset_m = 20.0,
                          .elements = {{ElementType::kStraight, 400.0, std::nullopt}},
                          .heading_deg = -8.0,
                          .start_s_m = 100.0});
  EXPECT_THAT(FaultsOfNetwork(world),
              ElementsAre("/world/tracks/1: must not cross track \"main\" without an entry of "
                          "/world/diamond_crossings (got at 242.307 m)"));
}

TEST(CheckNetwork, ReportsOffsetsBeyondTheGroundAndTightCurves) {
  WorldSpec world = StraightLine(1000.0);
  world.tracks.push_back({.name = "wide", .offsets_m = {{100.0, 4.0}, {400.0, 90.0}}});
  world.tracks.push_back({.name = "bend", .offsets_m = {{100.0, -4.0}, {110.0, -9.0}}});
  EXPECT_THAT(FaultsOfNetwork(world),
              ElementsAre("/world/tracks/1: must lie within the ground's half width of 80 m (got "
                          "offset 90)",
                          testing::StartsWith("/world/tracks/2: must have no radius below 10 m "
                                              "(got 4.")));
}

TEST(CheckNetwork, FindsWhereABranchIsClear) {
  WorldSpec world = StraightLine(1000.0);
  world.tracks.push_back(Branch("left", 6.0, 300.0));
  const Network network = MakeNetwork(world, 1000.0);
  const auto clear_s_m =
      ClearChainage_m(network.courses[0], network.courses[1], network.turnouts[0], 3.5);
  ASSERT_TRUE(clear_s_m.has_value());
  // On the straight at 1:9 from where the tangents meet.
  EXPECT_NEAR(*clear_s_m, 300.0 + GeometryOf(TurnoutType::k9_190).tangent_m + 9.0 * 3.5, 1e-5);
}

}  // namespace
}  // namespace railcast
