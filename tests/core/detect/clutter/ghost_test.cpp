#include "core/detect/clutter/ghost.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/detect/base/beam_optics.h"
#include "tests/core/detect/facing_beams.h"

namespace railcast {
namespace {

constexpr std::uint32_t kGhostLabel = 30;

DetectorSpec WithGhosts(double reflectance) {
  DetectorSpec spec{
      .effects = {.surface_response = true, .extinction = true, .detection = true, .ghost = true}};
  spec.receiver.ghost_reflectance = reflectance;
  spec.clutter_labels.ghost = kGhostLabel;
  return spec;
}

FacingBeams BeforeSheeting(double first_m, double step_m) {
  FacingBeams beams{.num_firings = kTileSize,
                    .optics = LaneOpticsOf(
                        {.diffuse = 0.2F, .specular_roughness = 0.3F, .retroreflectance = 570.0F})};
  beams.range_m = [=](std::uint32_t firing) { return first_m + step_m * firing; };
  return beams;
}

// What a sensor gets that sends the returned share of the light once more: power over P_min, with
// the light followed step by step in watts.
double GhostRatio(double range_m, double reflectance, double extinction_per_m) {
  const DetectorSpec spec;
  const double sent_W = 75.0;
  const double radius_m = 0.005;
  const double area_m2 = std::numbers::pi * radius_m * radius_m;
  const double rho = 570.2;
  const double both_ways = std::exp(-2.0 * extinction_per_m * range_m);
  // Irradiance at the sensor by a surface of effective reflectance rho that faces a beam.
  const auto irradiance_W_per_m2 = [&](double power_W) {
    return power_W * both_ways * rho / (std::numbers::pi * range_m * range_m);
  };
  const double second_W = reflectance * area_m2 * irradiance_W_per_m2(sent_W);
  const double received_W = area_m2 * irradiance_W_per_m2(second_W);
  const double white_at_1_m_W = area_m2 * sent_W / std::numbers::pi;
  return received_W / white_at_1_m_W / LeastPower(spec.receiver);
}

TEST(Ghost, HasThePowerOfLightThatGoesTheWayTwice) {
  for (const double extinction_per_m : {0.0, 0.02}) {
    DetectorSpec spec = WithGhosts(0.1);
    spec.weather.fog_density_per_m = extinction_per_m;
    const auto ghosts = ClutterOf(DetectFacing(spec, BeforeSheeting(2.0, 0.1)));
    ASSERT_GT(ghosts.size(), 30U);
    double farthest_m = 0.0;
    for (const FacingEcho& ghost : ghosts) {
      if (ghost.outcome != Outcome::kClutter) continue;
      const double range_m = static_cast<double>(ghost.true_range_m) / 2.0;
      const double expected = GhostRatio(range_m, 0.1, extinction_per_m);
      EXPECT_NEAR(static_cast<double>(ghost.power_ratio), expected, 1e-4 * expected);
      EXPECT_EQ(ghost.clutter, kGhostLabel);
      EXPECT_EQ(ghost.range_m, ghost.true_range_m);
      farthest_m = std::max(farthest_m, range_m);
    }
    // The last distance, in steps of 0.1 m, at which the ghost exceeds the threshold.
    EXPECT_GE(GhostRatio(farthest_m, 0.1, extinction_per_m), 1.0);
    EXPECT_LT(GhostRatio(farthest_m + 0.1, 0.1, extinction_per_m), 1.0);
  }
}

TEST(Ghost, HasADetectionRangeThatGrowsWithTheRootOfTheRootOfTheReflectance) {
  const auto farthest_m = [](double reflectance) {
    double most_m = 0.0;
    for (const FacingEcho& ghost :
         ClutterOf(DetectFacing(WithGhosts(reflectance), BeforeSheeting(1.0, 0.25)))) {
      if (ghost.outcome == Outcome::kClutter)
        most_m = std::max(most_m, static_cast<double>(ghost.range_m) / 2.0);
    }
    return most_m;
  };
  // (reflectance (5 mm)^2 570.2^2 / P_min)^(1/4) is 23.9 m at 0.1.
  EXPECT_NEAR(farthest_m(0.1), 23.9, 0.25);
  EXPECT_NEAR(farthest_m(0.1 / 16.0), 23.9 / 2.0, 0.25);
  EXPECT_EQ(farthest_m(0.0), 0.0);
}

TEST(Ghost, IsThatOfARetroreflectorAlone) {
  FacingBeams beams = BeforeSheeting(1.0, 0.0);
  beams.optics = LaneOpticsOf({.diffuse = 0.95F, .specular_roughness = 0.3F});
  EXPECT_TRUE(ClutterOf(DetectFacing(WithGhosts(1.0), beams)).empty());
}

TEST(Ghost, BelongsToTheStrongestEchoOfItsBeam) {
  EchoTiles echoes;
  FillHits(BeforeSheeting(20.0, 0.0), 0, echoes);
  std::fill_n(echoes.first.power_ratio, kTileSize, 1e5F);
  std::fill_n(echoes.first.intensity, kTileSize, 50.0F);
  const auto [tile, lane] = echoes.Add(9, 1);
  tile.true_range_m[lane] = 25.0F;
  tile.peak_shift_m[lane] = 0.5F;
  tile.power_ratio[lane] = 1e6F;
  tile.intensity[lane] = 500.0F;
  tile.outcome[lane] = static_cast<std::uint32_t>(Outcome::kReturned);
  tile.clutter[lane] = kNoClutter;
  Ghost(WithGhosts(1.0)).AddEchoes(echoes);
  ASSERT_EQ(echoes.num_more(), 1U + kTileSize) << "one for each beam";
  for (std::size_t i = 1; i < echoes.num_more(); ++i) {
    const auto [ghosts, k] = echoes.more(i);
    EXPECT_EQ(ghosts.true_range_m[k], echoes.beam_of(i) == 9 ? 51.0F : 40.0F);
  }
}

}  // namespace
}  // namespace railcast
