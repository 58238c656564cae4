#include "core/detect/clutter/halo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/units.h"
#include "tests/core/detect/facing_beams.h"

namespace railcast {
namespace {

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
