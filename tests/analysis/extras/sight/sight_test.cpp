#include "analysis/extras/sight/sight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/base/units.h"
#include "core/rail/clearance/tunnel_shape.h"
#include "core/rail/landform/landform.h"
#include "core/rail/track/cross_section.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/core/rail/world/made_track.h"

namespace railcast {
namespace {

constexpr double kSeenUpTo_m = 400.0;
constexpr double kEye_m = 2.5;

/// A bare line without plants, wires and relief. The vehicle stands at 100 m, its sensor over the
/// axis.
ScenarioSpec BareLine(ScenarioSpec scenario) {
  WorldSpec& world = scenario.world;
  world.tracks.resize(1);
  world.catenary.enabled = false;
  world.terrain.roughness_sigma_m = 0.0;
  world.terrain.undulation_sigma_m = 0.0;
  world.vegetation.trees_per_hectare = 0.0;
  world.vegetation.grass = false;
  scenario.vehicle.start_s_m = 100.0;
  scenario.vehicle.pivot_distance_m = 0.0;
  scenario.lidar.mount.position_m = {0.0, 0.0, kEye_m};
  scenario.lidar.range_max_m = kSeenUpTo_m;
  return scenario;
}

std::vector<SightPlace> Follow(const ScenarioSpec& scenario, const SightSpec& spec) {
  return FollowSight(scenario, spec, [](double) {});
}

TEST(Sight, ReachesToTheRangeOnStraightLevelTrack) {
  const auto places = Follow(BareLine(ScenarioOn(ElementType::kStraight, 1'000.0)), {});
  ASSERT_EQ(places.size(), 1U);
  ASSERT_EQ(places[0].sights.size(), 3U);
  EXPECT_NEAR(places[0].chainage_m, 100.0, 1e-6);
  for (const Sight& sight : places[0].sights) {
    EXPECT_EQ(sight.end, SightEnd::kRange);
    EXPECT_DOUBLE_EQ(sight.distance_m, kSeenUpTo_m);
  }
}

TEST(Sight, IsNotKnownBeyondTheEndOfTheTrack) {
  const auto places = Follow(BareLine(ScenarioOn(ElementType::kStraight, 350.5)), {});
  ASSERT_EQ(places.size(), 1U);
  EXPECT_EQ(places[0].sights[0].end, SightEnd::kEndOfTrack);
  EXPECT_NEAR(places[0].sights[0].distance_m, 250.0, 1e-9);
  EXPECT_FALSE(places[0].IsShort(0)) << "it may be longer";
}

// The line of sight along the chord touches the wall where it comes nearest to the centre of the
// circle: R cos(s / (2 R)) = R - d, so s = 2 R acos((R - d) / R). Half of the target is seen where
// the chord to its middle passes, d beside the posts, which stand 2 cm out of the wall, or a little
// more between two of them. The last target that is seen stands less than a step before.
void ExpectSightAlongTheChord(double radius_m) {
  ScenarioSpec scenario = BareLine(ScenarioOn(ElementType::kArc, 1'000.0, radius_m));
  NoiseWallSpec wall;
  wall.name = "wall";
  wall.side = TrackSide::kLeft;
  wall.begin_s_m = 50.0;
  wall.end_s_m = 600.0;
  scenario.world.structures = {wall};
  const auto places = Follow(scenario, {.heights_m = {1.0, 2.0}});
  ASSERT_EQ(places.size(), 1U);
  const auto chord_m = [&](double d_m) {
    return 2.0 * radius_m * std::acos((radius_m - d_m) / radius_m);
  };
  for (const Sight& sight : places[0].sights) {
    EXPECT_EQ(sight.end, SightEnd::kBlocked);
    EXPECT_LE(sight.distance_m, chord_m(wall.distance_m));
    EXPECT_GT(sight.distance_m, chord_m(wall.distance_m - 0.02) - kTargetStep_m);
    EXPECT_EQ(sight.blocker, "noise_wall");
  }
  EXPECT_TRUE(places[0].IsShort(0) == (places[0].sights[0].distance_m < places[0].needed_m));
}

TEST(Sight, EndsWhereTheChordTouchesAWallInsideACurve) {
  ExpectSightAlongTheChord(400.0);
  // An eighth of the target's width is 2 m of sight here.
  ExpectSightAlongTheChord(2'000.0);
}

// As before a wall, at the half width that the vault has where the line of sight touches it:
// halfway between the eye and the target, between the height of the vault's centre and the mean of
// both.
TEST(Sight, EndsAtTheVaultOfACurvedTunnel) {
  constexpr double kRadius_m = 300.0;
  constexpr double kVault_m = 3.5;
  constexpr double kTarget_m = 2.0;
  constexpr double kCentre_m = TunnelShape::kVaultCentre_m;
  ScenarioSpec scenario = BareLine(ScenarioOn(ElementType::kArc, 1'000.0, kRadius_m));
  TunnelSpec tunnel;
  tunnel.name = "tunnel";
  tunnel.begin_s_m = 20.0;
  tunnel.end_s_m = 700.0;
  tunnel.radius_m = kVault_m;
  tunnel.niche_spacing_m = 0.0;
  tunnel.has_handrail = false;
  scenario.world.structures = {tunnel};
  const auto places = Follow(scenario, {.heights_m = {kTarget_m}});
  ASSERT_EQ(places.size(), 1U);
  const auto chord_m = [&](double touched_m) {
    const double half_m = std::sqrt(kVault_m * kVault_m - std::pow(touched_m - kCentre_m, 2));
    return 2.0 * kRadius_m * std::acos((kRadius_m - half_m) / kRadius_m);
  };
  const Sight& sight = places[0].sights[0];
  EXPECT_EQ(sight.end, SightEnd::kBlocked);
  EXPECT_EQ(sight.blocker, "tunnel");
  EXPECT_GT(sight.distance_m, chord_m(0.5 * (kEye_m + kTarget_m)) - kTargetStep_m);
  EXPECT_LT(sight.distance_m, chord_m(kCentre_m));
}

// As in a tunnel, but the slope of 1:1.5 beside the formation is farther out the higher the line of
// sight touches it: between the mean height of the eye and the target's foot, and the eye's height.
TEST(Sight, EndsAtTheSlopeOfACuttingInACurve) {
  constexpr double kRadius_m = 400.0;
  constexpr double kTarget_m = 1.0;
  const TemporaryDirectory directory;
  const auto plateau = directory.path() / "plateau.asc";
  std::ofstream(plateau) << "ncols 3\nnrows 3\nxllcorner -1000\nyllcorner -500\ncellsize 800\n"
                            "8 8 8\n8 8 8\n8 8 8\n";
  ScenarioSpec scenario = BareLine(ScenarioOn(ElementType::kArc, 600.0, kRadius_m));
  scenario.world.terrain.half_width_m = 40.0;
  scenario.world.terrain.elevation =
      ElevationSpec{.file = plateau.string(), .origin_m = {0.0, 0.0, 0.0}};
  const auto places = Follow(scenario, {.heights_m = {kTarget_m}});
  ASSERT_EQ(places.size(), 1U);
  const auto chord_m = [&](double touched_m) {
    const double lateral_m =
        kFormationEdge_m + (touched_m + CrossSection::kFormationDepth_m) / kCutAndFillSlope;
    return 2.0 * kRadius_m * std::acos((kRadius_m - lateral_m) / kRadius_m);
  };
  const Sight& sight = places[0].sights[0];
  EXPECT_EQ(sight.end, SightEnd::kBlocked);
  EXPECT_EQ(sight.blocker, "ground");
  EXPECT_GT(sight.distance_m, chord_m(0.5 * kEye_m) - kTargetStep_m);
  EXPECT_LT(sight.distance_m, chord_m(kEye_m) + kTargetStep_m);
}

// On a crest of the vertical radius R, the line of sight from the height h_1 touches the track at
// sqrt(2 R h_1) and sees the height h_2 as far beyond it: s = sqrt(2 R) (sqrt(h_1) + sqrt(h_2)).
// Half of a target is seen where its middle is: h_2 is half of its height. Between the rails the
// line touches the middles of sleepers, or grains of the ballast that rise above them by less than
// 2 cm. The last target that is seen stands less than a step before.
TEST(Sight, EndsBehindACrest) {
  constexpr double kCrest_m = 300.0;
  constexpr double kBreak = 0.08;
  constexpr double kRadius_m = kCrest_m / kBreak;
  constexpr double kTarget_m = 2.0;
  ScenarioSpec scenario = BareLine(ScenarioOn(ElementType::kStraight, 1'000.0));
  scenario.world.alignment.gradients_permil = {{0.0, 40.0}, {400.0, -40.0}};
  scenario.world.alignment.gradient_smoothing_m = kCrest_m;
  scenario.vehicle.start_s_m = 400.0 - 0.5 * kCrest_m;
  const auto places = Follow(scenario, {.heights_m = {kTarget_m}});
  ASSERT_EQ(places.size(), 1U);
  const SleeperSeat seat = SeatOf(SleeperType::kConcrete);
  const double below_m = seat.middle_drop_m - seat.top_m;
  const auto sight_over_m = [&](double touched_m) {
    return std::sqrt(2.0 * kRadius_m) *
           (std::sqrt(kEye_m + touched_m) + std::sqrt(0.5 * kTarget_m + touched_m));
  };
  EXPECT_EQ(places[0].sights[0].end, SightEnd::kBlocked);
  EXPECT_LE(places[0].sights[0].distance_m, sight_over_m(below_m));
  EXPECT_GT(places[0].sights[0].distance_m, sight_over_m(below_m - 0.02) - kTargetStep_m);
}

TEST(Sight, NeedsTheBrakingDistanceOnTheGradientInTheDirectionOfTravel) {
  constexpr double kSpeed_mps = 20.0;
  ScenarioSpec scenario = BareLine(ScenarioOn(ElementType::kStraight, 1'500.0));
  scenario.world.alignment.gradients_permil = {{0.0, 10.0}};
  scenario.vehicle.start_s_m = 750.0;
  // The first place only.
  const SightSpec spec{
      .heights_m = {1.0}, .step_m = 1'000.0, .range_m = 50.0, .speed_mps = kSpeed_mps};
  for (const bool is_reverse : {false, true}) {
    scenario.vehicle.motion.reverse = is_reverse;
    const auto places = Follow(scenario, spec);
    ASSERT_EQ(places.size(), 1U);
    const double gradient = is_reverse ? -0.01 : 0.01;
    EXPECT_NEAR(places[0].gradient, gradient, 1e-9);
    EXPECT_NEAR(
        places[0].needed_m,
        2.0 * kSpeed_mps + kSpeed_mps * kSpeed_mps / (2.0 * (0.5 + 9.80665 * gradient)) + 15.0,
        1e-6);
    EXPECT_TRUE(places[0].IsShort(0)) << "the range is too short";
  }
}

TEST(Sight, IsSoughtAtTheVehiclesOwnSpeedFromPlacesAStepApart) {
  ScenarioSpec scenario = BareLine(ScenarioOn(ElementType::kStraight, 400.0));
  scenario.vehicle.motion.profile = {{.time_s = 0.0, .s_m = {}, .speed_mps = 20.0}};
  const auto places = Follow(scenario, {.heights_m = {1.0}, .step_m = 50.0, .range_m = 50.0});
  ASSERT_GE(places.size(), 6U);
  for (std::size_t i = 1; i < places.size(); ++i) {
    EXPECT_GE(places[i].chainage_m - places[i - 1].chainage_m, 50.0 - 1e-6);
    EXPECT_LE(places[i].chainage_m - places[i - 1].chainage_m, 52.0 + 1e-6);
    EXPECT_DOUBLE_EQ(places[i].speed_mps, 20.0);
  }
}

TEST(Sight, IsSoughtOnTheWholeRouteAtAGivenSpeed) {
  // The vehicle of the scenario stands.
  const ScenarioSpec scenario = BareLine(ScenarioOn(ElementType::kStraight, 400.0));
  const auto places =
      Follow(scenario, {.heights_m = {1.0}, .step_m = 100.0, .range_m = 50.0, .speed_mps = 30.0});
  ASSERT_EQ(places.size(), 3U);
  EXPECT_NEAR(places[2].chainage_m, 300.0, 3.0 * 2.0) << "a frame is 3 m";
  EXPECT_DOUBLE_EQ(places[2].speed_mps, 30.0);
}

TEST(Sight, TellsWhichShareOfThePlacesIsDone) {
  const ScenarioSpec scenario = BareLine(ScenarioOn(ElementType::kStraight, 400.0));
  std::vector<double> done;
  (void)FollowSight(scenario,
                    {.heights_m = {1.0}, .step_m = 50.0, .range_m = 50.0, .speed_mps = 30.0},
                    [&](double share) { done.push_back(share); });
  ASSERT_EQ(done.size(), 6U);
  for (std::size_t i = 0; i < done.size(); ++i) {
    EXPECT_DOUBLE_EQ(done[i], static_cast<double>(i + 1) / 6.0);
  }
}

/// A place 50 m behind the one before, with one target.
SightPlace PlaceWith(double chainage_m, double sight_m, const std::string& blocker) {
  return {.chainage_m = chainage_m,
          .needed_m = 200.0,
          .sights = {{sight_m, blocker.empty() ? SightEnd::kRange : SightEnd::kBlocked, blocker}}};
}

TEST(ShortSights, ArePartsOfTheWayWithOneBlocker) {
  const std::vector<SightPlace> places = {
      PlaceWith(0.0, 250.0, ""),         PlaceWith(50.0, 150.0, "tree"),
      PlaceWith(100.0, 120.0, "tree"),   PlaceWith(150.0, 130.0, "tree"),
      PlaceWith(200.0, 180.0, "tunnel"), PlaceWith(250.0, 300.0, ""),
      PlaceWith(300.0, 190.0, "tunnel")};
  const auto parts = ShortSights(places, {.heights_m = {0.3}});
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts[0].blocker, "tree");
  EXPECT_EQ(parts[0].from_s_m, 50.0);
  EXPECT_EQ(parts[0].to_s_m, 150.0);
  EXPECT_EQ(parts[0].worst.chainage_m, 100.0);
  EXPECT_EQ(parts[0].spare_m(), -80.0);
  EXPECT_EQ(parts[1].blocker, "tunnel");
  EXPECT_EQ(parts[2].from_s_m, 300.0);
}

}  // namespace
}  // namespace railcast
