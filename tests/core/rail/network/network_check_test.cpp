#include "core/rail/network/network_draft.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/rail/network/turnout_place.h"
#include "tests/core/rail/test_line.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

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
