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
  for (const TurnoutType type :
       {TurnoutType::k9_190, TurnoutType::k9_300, TurnoutType::k12_500, TurnoutType::k14_760}) {
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

}  // namespace
}  // namespace railcast
