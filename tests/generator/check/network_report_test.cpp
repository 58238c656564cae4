#include "generator/check/check_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <optional>

#include "railcast/scenario.h"

namespace railcast {
namespace {

using testing::HasSubstr;

/// A straight line with a loop from 300 to 700 m on its left, through which the vehicle runs.
ScenarioSpec RunThroughALoop(double speed_mps) {
  ScenarioSpec scenario = ReadScenario(RAILCAST_SOURCE_DIR "/scenarios/minimal.json");
  WorldSpec world;
  world.alignment.course = AlignmentElementsSpec{{{ElementType::kStraight, 1000.0, {}}}};
  world.tracks.push_back({.name = "loop",
                          .offset_m = 4.5,
                          .begin = TurnoutSpec{"main", 300.0, TurnoutType::k9_190, {}, {}},
                          .end = TurnoutSpec{"main", 700.0, TurnoutType::k9_300, {}, {}}});
  world.vegetation.grass = false;
  world.vegetation.trees_per_hectare = 0.0;
  scenario.world = world;
  scenario.vehicle = {};
  scenario.vehicle.route = {"main", "loop", "main"};
  scenario.vehicle.start_s_m = 250.0;
  scenario.vehicle.motion.profile = {{0.0, {}, speed_mps}};
  return scenario;
}

struct Loop {
  ScenarioSpec scenario;
  std::shared_ptr<const RailWorld> world;
  std::optional<LateralPeak> peak;

  explicit Loop(double speed_mps) : scenario(RunThroughALoop(speed_mps)) {
    world = MakeWorld(scenario);
    const VehicleWay way = FindVehicleWay(scenario.vehicle, world->vehicle_course());
    peak = FindLateralPeak(*world, scenario.vehicle, way);
  }
};

TEST(NetworkReport, NamesTracksWithTheirRadiiAndTurnouts) {
  const std::string text = NetworkText(*Loop(10.0).world);
  EXPECT_THAT(text, HasSubstr("tracks    \"main\": 1000 m from s 0 m to 1000 m, straight\n"));
  EXPECT_THAT(text, HasSubstr("turnout 1:9-190 of track \"loop\" at s 300 m: to the left, opens "
                              "with rising chainage, set diverging, fouling point at s 3"));
  EXPECT_THAT(text, HasSubstr("turnout 1:9-300 of track \"loop\" at s 700 m: to the left, opens "
                              "with falling chainage, set diverging, fouling point at s 6"));
  // Each S-curve is longer than its chainages: two arcs by 2 R (a - sin a), the straight between
  // them by what it rises times (1 - cos a) / sin a; 0.206 and 0.181 m.
  EXPECT_THAT(text,
              HasSubstr("\"loop\": 400.4 m from s 300 m to 700 m, tightest radius 190 m at s 3"));
}

TEST(NetworkReport, FindsTheLargestLateralAccelerationInTheTightestArc) {
  const Loop loop(10.0);
  ASSERT_TRUE(loop.peak);
  EXPECT_NEAR(loop.peak->acceleration_mps2, 100.0 / 190.0, 1e-3);
  EXPECT_EQ(loop.peak->balanced_mps2, 0.0);
  EXPECT_GE(loop.peak->point.s_m, 300.0);
  EXPECT_LT(loop.peak->point.s_m, 360.0);
  const std::string text = RouteText(*loop.world, loop.peak);
  EXPECT_THAT(text, HasSubstr("its route is \"main\", \"loop\", \"main\"\n"));
  EXPECT_THAT(text, HasSubstr("has its largest lateral acceleration of 0.5263 m/s^2 at s 3"));
}

TEST(NetworkReport, SaysWhatCantBalances) {
  ScenarioSpec scenario = RunThroughALoop(20.0);
  scenario.world.alignment.course = AlignmentElementsSpec{{{ElementType::kArc, 1000.0, 400.0}}};
  scenario.world.alignment.cants_mm = {{0.0, 100.0}};
  scenario.world.tracks.resize(1);
  scenario.vehicle.route.clear();
  const std::shared_ptr<const RailWorld> world = MakeWorld(scenario);
  const std::optional<LateralPeak> peak = FindLateralPeak(
      *world, scenario.vehicle, FindVehicleWay(scenario.vehicle, world->vehicle_course()));
  ASSERT_TRUE(peak);
  EXPECT_NEAR(peak->balanced_mps2, 9.80665 * 100.0 / 1500.0, 1e-9);
  EXPECT_NEAR(peak->acceleration_mps2, 400.0 / 400.0 - peak->balanced_mps2, 1e-6);
}

TEST(NetworkReport, IsEmptyOfASingleTrack) {
  ScenarioSpec scenario = RunThroughALoop(20.0);
  scenario.world.tracks.resize(1);
  scenario.vehicle.route.clear();
  const std::shared_ptr<const RailWorld> world = MakeWorld(scenario);
  EXPECT_EQ(NetworkText(*world), "");
  EXPECT_FALSE(FindLateralPeak(*world, scenario.vehicle,
                               FindVehicleWay(scenario.vehicle, world->vehicle_course())));
}

TEST(NetworkReport, NamesTheTracksThatATrackCrosses) {
  const auto world = MakeWorld(ReadScenario(RAILCAST_SOURCE_DIR "/scenarios/diamond.json"));
  const std::string text = NetworkText(*world);
  // 16 m to the left at 1:9. Frogs 0.7175 m / tan(3.17 deg) = 12.95 m off, rails whole 2.25 m on.
  EXPECT_THAT(text, HasSubstr("crosses track \"works_line\" at s 144 m: 1:9, frogs and check rails "
                              "from s 128.8 m to 159.2 m\n"));
  EXPECT_THAT(text, HasSubstr("crosses track \"works_line\" at s 216 m: 1:9"));
}

}  // namespace
}  // namespace railcast
