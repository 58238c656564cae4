#include "core/rail/network/route.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/rail/motion/track_path.h"
#include "core/rail/network/network_draft.h"
#include "core/rail/network/turnout_place.h"
#include "core/rail/world/world_draft.h"
#include "tests/core/rail/test_line.h"
#include "tests/core/rail/test_tables.h"

namespace railcast {
namespace {

using testing::ElementsAre;

/// main with a loop from 300 to 700 m on its left, and a track apart.
WorldSpec LineWithALoop() {
  WorldSpec world = StraightLine(1000.0);
  world.tracks.push_back({.name = "loop",
                          .offset_m = 4.5,
                          .begin = TurnoutSpec{"main", 300.0, TurnoutType::k9_190, {}, {}},
                          .end = TurnoutSpec{"main", 700.0, TurnoutType::k9_300, {}, {}}});
  world.tracks.push_back({.name = "apart", .offset_m = -10.0});
  return world;
}

NetworkDraft NetworkOfLoop(const WorldSpec& world) {
  WorldFaults faults;
  NetworkDraft network = DraftNetwork(world, 1000.0, faults);
  EXPECT_TRUE(faults.errors.empty());
  return network;
}

std::optional<Route> RouteAlong(const WorldSpec& world,
                                const std::vector<std::string>& names,
                                bool runs_back = false) {
  WorldFaults faults;
  const NetworkDraft network = NetworkOfLoop(world);
  return MakeRoute(world, network, {"/vehicle/route", names, runs_back}, faults);
}

std::vector<std::string> FaultsOfRoute(const std::vector<std::string>& names, bool runs_back) {
  const WorldSpec world = LineWithALoop();
  WorldFaults faults;
  static_cast<void>(
      MakeRoute(world, NetworkOfLoop(world), {"/vehicle/route", names, runs_back}, faults));
  return faults.errors.lines();
}

std::vector<std::string> FaultsOfWorld(const WorldSpec& world, const VehicleSpec& vehicle) {
  WorldFaults faults;
  static_cast<void>(DraftWorld({world, vehicle, RailLabels(), RailMaterials()}, faults));
  return faults.errors.lines();
}

TEST(Route, ChangesTracksAtTheirTurnouts) {
  const WorldSpec world = LineWithALoop();
  const NetworkDraft network = NetworkOfLoop(world);
  const std::optional<Route> route = RouteAlong(world, {"main", "loop", "main"});
  ASSERT_TRUE(route.has_value());
  EXPECT_EQ(route->course.begin_s_m(), 0.0);
  EXPECT_EQ(route->course.end_s_m(), 1000.0);
  ASSERT_EQ(route->sections.size(), 3U);
  EXPECT_EQ(route->sections[1].begin_s_m, 300.0);
  EXPECT_EQ(route->sections[1].end_s_m, 700.0);
  for (const double s_m : {100.0, 320.0, 500.0, 690.0, 900.0}) {
    const auto& track = *network.courses[s_m > 300.0 && s_m < 700.0 ? 1 : 0];
    EXPECT_EQ(route->course.OffsetAt(s_m).d_m, track.OffsetAt(s_m).d_m) << s_m;
  }
}

TEST(Route, IsTheSameWayBackwards) {
  const WorldSpec world = LineWithALoop();
  const std::optional<Route> route = RouteAlong(world, {"loop", "main"}, true);
  ASSERT_TRUE(route.has_value());
  EXPECT_EQ(route->course.begin_s_m(), 0.0);
  EXPECT_EQ(route->course.end_s_m(), 700.0);
  EXPECT_EQ(route->course.OffsetAt(200.0).d_m, 0.0);
  EXPECT_EQ(route->course.OffsetAt(500.0).d_m, 4.5);
}

// The pose of a vehicle with two pivots, every centimetre over both turnouts. No curve is tighter
// than 190 m: the body turns by less than 1.05 x 0.01 / 190 in a step, and moves by the step.
TEST(Route, LeadsAVehicleSmoothlyThroughTurnouts) {
  const WorldSpec world = LineWithALoop();
  const Alignment alignment(world.alignment);
  constexpr double kStep_m = 0.01;
  constexpr double kMostTurn_rad = 1.05 * kStep_m / 190.0;
  for (const double pivot_distance_m : {0.0, 10.4}) {
    const TrackPath path(*RouteAlong(world, {"main", "loop", "main"}),
                         {.pivot_distance_m = pivot_distance_m}, SpeedProfile({}, 0.0));
    Transform before = path.WorldFromObjectAt(alignment, 280.0);
    for (int i = 1; i <= 45'000; ++i) {
      const Transform here = path.WorldFromObjectAt(alignment, 280.0 + kStep_m * i);
      const double turn_rad = before.linear().col(0).cross(here.linear().col(0)).norm();
      ASSERT_LT(turn_rad, kMostTurn_rad) << i;
      // At 1:9 a centimetre of chainage is 10.06 mm of track.
      ASSERT_NEAR((here.translation() - before.translation()).norm(), kStep_m, 7e-5) << i;
      before = here;
    }
  }
}

TEST(Route, PutsBothPivotsOnTheTrackBeforeAndBehindATurnout) {
  const WorldSpec world = LineWithALoop();
  const Alignment alignment(world.alignment);
  const std::optional<Route> route = RouteAlong(world, {"main", "loop", "main"});
  const TrackPath path(*route, {.pivot_distance_m = 10.4}, SpeedProfile({}, 0.0));
  for (const double s_m : {295.0, 303.0, 309.0, 325.0, 695.0, 703.0, 709.0}) {
    const Transform body = path.WorldFromObjectAt(alignment, s_m);
    const Vector3 rear = body * Vector3(-10.4, 0.0, 0.0);
    EXPECT_NEAR(rear.y(), route->course.OffsetAt(rear.x()).d_m, 1e-9) << s_m;
  }
}

TEST(Route, ReportsTracksThatDoNotMeetAndTheWrongWay) {
  EXPECT_THAT(
      FaultsOfRoute({"main", "apart"}, false),
      ElementsAre("/vehicle/route/1: must be a track that a turnout joins to track \"main\" "
                  "(got \"apart\")"));
  EXPECT_THAT(FaultsOfRoute({"main", "loop", "mian"}, false),
              ElementsAre("/vehicle/route/2: must be one of \"main\", \"loop\", \"apart\" (got "
                          "\"mian\")"));
  EXPECT_THAT(FaultsOfRoute({"loop", "main", "loop"}, false),
              ElementsAre("/vehicle/route/2: must be joined to track \"main\" behind 700 m, where "
                          "the route comes from, not at 300 m (got \"loop\")"));
  WorldSpec world = LineWithALoop();
  world.tracks[1].end.reset();
  WorldFaults faults;
  static_cast<void>(
      MakeRoute(world, NetworkOfLoop(world), {"/vehicle/route", {"loop", "main"}, false}, faults));
  EXPECT_THAT(
      faults.errors.lines(),
      ElementsAre("/vehicle/route/1: must be reached from track \"loop\" the right way: the "
                  "turnout at 300 m opens with rising chainage, and the route runs with "
                  "rising chainage (got \"main\")"));
}

TEST(Route, ReportsTurnoutsThatAreSetAgainstIt) {
  WorldSpec world = LineWithALoop();
  world.tracks[1].begin->position = TurnoutPosition::kStraight;
  VehicleSpec vehicle;
  vehicle.route = {"main", "loop"};
  vehicle.motion.profile = {{.time_s = 0.0, .s_m = {}, .speed_mps = 5.0}};
  EXPECT_THAT(
      FaultsOfWorld(world, vehicle),
      ElementsAre("/world/tracks/1/begin/position: must be \"diverging\", as /vehicle/route "
                  "needs it (got \"straight\")"));
  // Behind the turnout its position does not matter.
  vehicle.start_s_m = 350.0;
  EXPECT_THAT(FaultsOfWorld(world, vehicle), testing::IsEmpty());
  // A vehicle that stays on its track needs it straight.
  world.tracks[1].begin->position = TurnoutPosition::kDiverging;
  vehicle.route.clear();
  vehicle.start_s_m = 0.0;
  EXPECT_THAT(FaultsOfWorld(world, vehicle),
              ElementsAre("/world/tracks/1/begin/position: must be \"straight\", as /vehicle/track "
                          "needs it (got \"diverging\")"));
}

TEST(Route, SetsTheTurnoutsThatHaveNoPosition) {
  const WorldSpec world = LineWithALoop();
  VehicleSpec vehicle;
  vehicle.route = {"main", "loop"};
  WorldFaults faults;
  const WorldDraft draft = DraftWorld({world, vehicle, RailLabels(), RailMaterials()}, faults);
  ASSERT_EQ(draft.network.turnouts.size(), 2U);
  EXPECT_EQ(draft.network.turnouts[0].position, TurnoutPosition::kDiverging);
  EXPECT_EQ(draft.network.turnouts[1].position, TurnoutPosition::kStraight);
}

TEST(Route, LeavesATurnoutBehindTheVehicleAsItIsGiven) {
  WorldSpec world = LineWithALoop();
  world.tracks[1].begin->position = TurnoutPosition::kStraight;
  VehicleSpec vehicle;
  vehicle.route = {"main", "loop"};
  vehicle.start_s_m = 350.0;
  WorldFaults faults;
  const WorldDraft draft = DraftWorld({world, vehicle, RailLabels(), RailMaterials()}, faults);
  ASSERT_EQ(draft.network.turnouts.size(), 2U);
  EXPECT_EQ(draft.network.turnouts[0].position, TurnoutPosition::kStraight);
}

TEST(Route, WantsTheVehicleOnIt) {
  const WorldSpec world = LineWithALoop();
  VehicleSpec vehicle;
  vehicle.route = {"main", "loop"};
  vehicle.start_s_m = 800.0;
  EXPECT_THAT(FaultsOfWorld(world, vehicle),
              ElementsAre("/vehicle/start_s_m: must lie on the route, from 0 to 700 m (got 800)"));
}

/// Figures of the norm in millimetres, of which some are cut off instead of rounded and lengths are
/// twice the rounded tangents.
struct NormFigures {
  TurnoutType type{};
  double angle_deg{};
  double tangent_m{};
  double length_m{};
};

TEST(TurnoutGeometry, HasTheLengthsAndTheAngleOfTheNorm) {
  constexpr double kMillimetre_m = 1.1e-3;
  for (const NormFigures& norm : {NormFigures{TurnoutType::k9_190, 6.3402, 10.523, 27.138},
                                  {TurnoutType::k9_300, 6.3402, 16.615, 33.230},
                                  {TurnoutType::k12_500, 4.7636, 20.797, 41.594},
                                  {TurnoutType::k14_760, 4.0856, 27.108, 54.216}}) {
    const TurnoutGeometry geometry = GeometryOf(norm.type);
    EXPECT_NEAR(DegFromRad(geometry.angle_rad), norm.angle_deg, 0.5e-4);
    EXPECT_NEAR(geometry.tangent_m, norm.tangent_m, kMillimetre_m);
    EXPECT_NEAR(geometry.length_m, norm.length_m, kMillimetre_m);
  }
}

TEST(TurnoutGeometry, EndsBothAxesAtTheSameDistanceFromWhereTheirTangentsMeet) {
  for (const TurnoutType type : kTurnoutTypes) {
    const TurnoutGeometry geometry = GeometryOf(type);
    // The arc begins and ends at the tangent length from that point.
    EXPECT_NEAR(geometry.straight_m() + geometry.tangent_m, geometry.length_m - geometry.tangent_m,
                1e-12);
    EXPECT_GE(geometry.straight_m(), 0.0);
    EXPECT_LT(geometry.arc_m(), 2.0 * geometry.tangent_m);
  }
}

}  // namespace
}  // namespace railcast
