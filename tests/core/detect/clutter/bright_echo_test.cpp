#include "core/detect/clutter/bright_echo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/units.h"
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
  const double sent_w = 75.0;
  const double radius_m = 0.005;
  const double area_m2 = std::numbers::pi * radius_m * radius_m;
  const double rho = 570.2;
  const double both_ways = std::exp(-2.0 * extinction_per_m * range_m);
  // Irradiance at the sensor by a surface of effective reflectance rho that faces a beam.
  const auto irradiance_w_per_m2 = [&](double power_w) {
    return power_w * both_ways * rho / (std::numbers::pi * range_m * range_m);
  };
  const double second_w = reflectance * area_m2 * irradiance_w_per_m2(sent_w);
  const double received_w = area_m2 * irradiance_w_per_m2(second_w);
  const double white_at_1_m_w = area_m2 * sent_w / std::numbers::pi;
  return received_w / white_at_1_m_w / LeastPower(spec.receiver);
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
      const double in_clear_air = GhostRatio(range_m, 0.1, 0.0) * LeastPower(spec.receiver);
      EXPECT_NEAR(static_cast<double>(ghost.intensity) / (4.0 * range_m * range_m * in_clear_air),
                  1.0, 1e-4);
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

constexpr double kShare = 1e-6;

DetectorSpec WithHalo() {
  DetectorSpec spec{.effects = {.detection = true, .halo = true}};
  spec.receiver.halo_share_at_1_deg = kShare;
  spec.clutter_labels.halo = 28;
  return spec;
}

/// 256 beams in a row, 0.02 deg apart, the first of them along +x, before a surface.
void FillFan(double surface_m, EchoTiles& echoes) {
  FillHits({.range_m = [=](std::uint32_t) { return surface_m; }}, 0, echoes);
  for (std::size_t i = 0; i < kTileSize; ++i) {
    const double azimuth_rad = RadFromDeg(0.02 * static_cast<double>(i));
    echoes.first.direction_x[i] = static_cast<float>(std::cos(azimuth_rad));
    echoes.first.direction_y[i] = static_cast<float>(std::sin(azimuth_rad));
  }
}

HaloSource AheadAt(float range_m, float power_ratio) {
  return {1.0F, 0.0F, 0.0F, range_m, power_ratio};
}

TEST(Halo, FallsWithTheFourthPowerOfTheAngle) {
  EchoTiles echoes;
  FillFan(80.0, echoes);
  Halo(WithHalo()).AddEchoes(echoes, {AheadAt(30.0F, 1e6F)});
  // (1e6 x 1e-6 / 0.3)^(1/4) = 1.351 deg: beams 0 to 67.
  ASSERT_EQ(echoes.num_more(), 68U);
  for (std::size_t i = 0; i < echoes.num_more(); ++i) {
    const auto [tile, lane] = echoes.more(i);
    ASSERT_EQ(echoes.beam_of(i), i);
    const double angle_deg = 0.02 * static_cast<double>(i);
    const double share = std::min(1.0, kShare / std::pow(angle_deg, 4));
    // A chord of 1.4 deg is shorter than the angle by 2.5e-5; directions are good to 6e-8.
    EXPECT_NEAR(static_cast<double>(tile.power_ratio[lane]), 1e6 * share,
                1e6 * share * (2e-4 + 2.4e-5 / std::max(angle_deg, 0.01)));
    EXPECT_EQ(tile.true_range_m[lane], 30.0F);
    EXPECT_EQ(tile.clutter[lane], 28U);
    EXPECT_EQ(static_cast<Outcome>(tile.outcome[lane]), Outcome::kClutter);
  }
}

TEST(Halo, HasTheIntensityBeforeAttenuationByTheAir) {
  DetectorSpec spec = WithHalo();
  spec.effects.extinction = true;
  spec.weather.fog_density_per_m = 0.02;
  EchoTiles echoes;
  FillFan(80.0, echoes);
  Halo(spec).AddEchoes(echoes, {AheadAt(30.0F, 1e6F)});
  const auto [tile, lane] = echoes.more(0);
  const double clear = std::exp(2.0 * 0.02 * 30.0) * LeastPower(spec.receiver) * 900.0;
  EXPECT_NEAR(static_cast<double>(tile.intensity[lane] / tile.power_ratio[lane]) / clear, 1.0,
              1e-5);
}

TEST(Halo, BelongsToTheStrongestSourceInEachBeam) {
  EchoTiles echoes;
  FillFan(80.0, echoes);
  HaloSource beside = AheadAt(50.0F, 1e6F);
  beside.x = static_cast<float>(std::cos(RadFromDeg(1.0)));
  beside.y = static_cast<float>(std::sin(RadFromDeg(1.0)));
  Halo(WithHalo()).AddEchoes(echoes, {AheadAt(30.0F, 1e6F), beside});
  for (std::size_t i = 0; i < echoes.num_more(); ++i) {
    if (echoes.beam_of(i) == 25) continue;  // In the middle between both.
    const auto [tile, lane] = echoes.more(i);
    EXPECT_EQ(tile.true_range_m[lane], echoes.beam_of(i) < 25 ? 30.0F : 50.0F);
  }
}

TEST(Halo, IsPartOfTheBeamsOwnEchoWhereBothAreAtOneRange) {
  EchoTiles echoes;
  FillFan(30.5, echoes);  // Two sigmas of a pulse of 5 ns are 0.637 m.
  Halo(WithHalo()).AddEchoes(echoes, {AheadAt(30.0F, 1e6F)});
  EXPECT_EQ(echoes.num_more(), 0U);
  FillFan(30.7, echoes);
  Halo(WithHalo()).AddEchoes(echoes, {AheadAt(30.0F, 1e6F)});
  EXPECT_EQ(echoes.num_more(), 68U);
}

TEST(Halo, ComesFromSurfacesBrighterThanWhite) {
  EchoTiles echoes;
  FillFan(30.0, echoes);
  const Halo halo(WithHalo());
  std::fill_n(echoes.first.power_ratio, kTileSize, 1e4F);
  std::fill_n(echoes.first.intensity, kTileSize, 1.0F);
  std::vector<HaloSource> sources;
  halo.CollectSources(echoes, sources);
  EXPECT_TRUE(sources.empty());
  echoes.first.intensity[7] = 2.0F;
  halo.CollectSources(echoes, sources);
  ASSERT_EQ(sources.size(), 1U);
  EXPECT_EQ(sources[0].y, echoes.first.direction_y[7]);
  EXPECT_EQ(sources[0].range_m, 30.0F);
  EXPECT_EQ(sources[0].power_ratio, 1e4F);
}

TEST(Halo, ReachesTheTilesThatHaveBeamsInIt) {
  EchoTiles echoes;
  FillFan(80.0, echoes);
  const Halo halo(WithHalo());
  const auto reaches_at = [&](double angle_deg) {
    HaloSource source = AheadAt(30.0F, 1e6F);
    source.x = static_cast<float>(std::cos(RadFromDeg(angle_deg)));
    source.y = static_cast<float>(std::sin(RadFromDeg(angle_deg)));
    return halo.Reaches(echoes.first, {source});
  };
  EXPECT_TRUE(reaches_at(-1.34));
  EXPECT_FALSE(reaches_at(-1.36));
  EXPECT_TRUE(reaches_at(2.0));
  EXPECT_FALSE(reaches_at(60.0));
  EXPECT_FALSE(halo.Reaches(echoes.first, {}));
}

}  // namespace

}  // namespace railcast
