#include "core/detect/effects/spray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/detect/base/beam_optics.h"
#include "tests/core/detect/facing_beams.h"

namespace railcast {
namespace {

/// A cloud along the x axis at a vehicle of 10 m that moves towards +x, with its rear at x = 30.
SprayCloud CloudAhead() {
  return {.rear = {30.0F, 0.0F, -2.0F},
          .back = {-1.0F, 0.0F, 0.0F},
          .left = {0.0F, 1.0F, 0.0F},
          .up = {0.0F, 0.0F, 1.0F},
          .body_m = 10.0F,
          .half_width_m = 2.0F,
          .height_m = 3.0F,
          .decay_m = 4.0F,
          .extinction_per_m = 0.1F};
}

DetectorSpec InSpray() {
  DetectorSpec spec{.seed = 5, .effects = {.spray = true}};
  spec.weather.spray_extinction_per_m = 0.1;
  spec.weather.wetness = 1.0;
  spec.clutter_labels.spray = 29;
  return spec;
}

constexpr float kOrigin[3] = {0.0F, 0.0F, 0.0F};

// The cloud begins five lengths of decay behind the vehicle, at 10 m, and ends at its front.
TEST(SprayPath, IsThePartOfTheRayInTheCloud) {
  const SprayPath along = PathIn(CloudAhead(), kOrigin, {1.0F, 0.0F, 0.0F});
  EXPECT_NEAR(along.begin_m, 10.0F, 1e-5F);
  EXPECT_NEAR(along.end_m, 40.0F, 1e-5F);
  const SprayPath across = PathIn(CloudAhead(), {25.0F, 50.0F, 0.0F}, {0.0F, -1.0F, 0.0F});
  EXPECT_NEAR(across.begin_m, 48.0F, 1e-5F);
  EXPECT_NEAR(across.end_m, 52.0F, 1e-5F);
  const SprayPath above = PathIn(CloudAhead(), {0.0F, 0.0F, 1.1F}, {1.0F, 0.0F, 0.0F});
  EXPECT_FALSE(above.end_m > above.begin_m);
  const SprayPath beside = PathIn(CloudAhead(), {0.0F, 0.0F, 0.0F}, {0.8F, 0.6F, 0.0F});
  EXPECT_FALSE(beside.end_m > beside.begin_m);
}

TEST(Spray, HasTheOpticalDepthOfItsExtinction) {
  const SprayCloud cloud = CloudAhead();
  const float directions[][3] = {
      {1.0F, 0.0F, 0.0F}, {0.999F, 0.0447F, 0.0F}, {0.995F, 0.0F, -0.0998F}};
  for (const auto& direction : directions) {
    const SprayPath path = PathIn(cloud, kOrigin, direction);
    double depth = 0.0;
    constexpr double kStep_m = 1e-3;
    for (double r_m = 0.5 * kStep_m; r_m < 60.0; r_m += kStep_m) {
      depth +=
          kStep_m * static_cast<double>(ExtinctionAt_per_m(cloud, path, static_cast<float>(r_m)));
      if (std::fmod(r_m, 5.0) > kStep_m) continue;
      // At the ends, up to one step of 0.1 per m is counted or not.
      EXPECT_NEAR(static_cast<double>(OpticalDepth(cloud, path, static_cast<float>(r_m))), depth,
                  3e-4)
          << r_m;
    }
  }
}

TEST(Spray, GrowsWithTheSquareOfTheSpeedAndWithWhatLiesOnTheGround) {
  WeatherSpec weather;
  weather.spray_extinction_per_m = 0.2;
  EXPECT_EQ(SprayExtinction_per_m(weather, 30.0), 0.0);
  weather.wetness = 0.5;
  EXPECT_NEAR(SprayExtinction_per_m(weather, 100.0 / 3.6), 0.1, 1e-12);
  EXPECT_NEAR(SprayExtinction_per_m(weather, 50.0 / 3.6), 0.025, 1e-12);
  weather.snow_cover = 1.0;
  EXPECT_NEAR(SprayExtinction_per_m(weather, 100.0 / 3.6), 0.2, 1e-12);
  EXPECT_EQ(SprayExtinction_per_m(weather, 0.0), 0.0);
}

/// Rays along x from the origin, as many as the tile has firings.
std::unique_ptr<RayTile> RaysAhead() {
  auto rays = std::make_unique<RayTile>();
  rays->num_rays = kTileSize;
  std::fill_n(rays->origin_x, kTileSize, 0.0F);
  std::fill_n(rays->origin_y, kTileSize, 0.0F);
  std::fill_n(rays->origin_z, kTileSize, 0.0F);
  std::fill_n(rays->direction_x, kTileSize, 1.0F);
  std::fill_n(rays->direction_y, kTileSize, 0.0F);
  std::fill_n(rays->direction_z, kTileSize, 0.0F);
  std::fill_n(rays->shutter, kTileSize, 0.0F);
  return rays;
}

/// The results of 2^16 beams through the cloud to a wall.
struct Passed {
  std::vector<double> ranges_m, intensities;
  float wall_ratio{};
};

/// @param shutter Of all rays.
/// @param way_m How far the cloud moves ahead from shutter 0 to 1.
Passed Pass(double wall_m, float shutter = 0.0F, float way_m = 0.0F) {
  const Detector detector(InSpray());
  const Spray spray(InSpray());
  const auto rays = RaysAhead();
  std::fill_n(rays->shutter, kTileSize, shutter);
  SprayCloud cloud = CloudAhead();
  cloud.way[0] = way_m;
  EchoTiles echoes;
  Passed passed;
  for (std::uint32_t begin = 0; begin < 1U << 16U; begin += kTileSize) {
    FillHits({.range_m = [=](std::uint32_t) { return wall_m; }}, begin, echoes);
    std::fill_n(echoes.first.power_ratio, kTileSize, 7.0F);
    spray.Apply(*rays, {cloud}, detector, echoes);
    passed.wall_ratio = echoes.first.power_ratio[0];
    for (std::size_t i = 0; i < echoes.num_more(); ++i) {
      const auto [tile, lane] = echoes.more(i);
      EXPECT_EQ(tile.clutter[lane], 29U);
      passed.ranges_m.push_back(static_cast<double>(tile.true_range_m[lane]));
      passed.intensities.push_back(static_cast<double>(tile.intensity[lane]));
    }
  }
  return passed;
}

// Optical depth: 0.1 x 4 m x (1 - e^-5) behind the vehicle and 0.1 x 10 m at it.
TEST(Spray, WeakensWhatIsBehindItBothWays) {
  const double depth = 0.1 * (4.0 * (1.0 - std::exp(-5.0)) + 10.0);
  EXPECT_NEAR(Pass(60.0).wall_ratio, 7.0 * std::exp(-2.0 * depth), 1e-5);
  const double half_way = 0.1 * (4.0 * (1.0 - std::exp(-5.0)) + 5.0);
  EXPECT_NEAR(Pass(35.0).wall_ratio, 7.0 * std::exp(-2.0 * half_way), 1e-5);
  EXPECT_EQ(Pass(9.0).wall_ratio, 7.0F);
}

// The cloud moves 2 m ahead until shutter 0.5: of what is at the vehicle, 3 m are left before the
// wall at 35 m.
TEST(Spray, MovesAheadDuringTheScan) {
  const double depth = 0.1 * (4.0 * (1.0 - std::exp(-5.0)) + 3.0);
  EXPECT_NEAR(Pass(35.0, 0.5F, 4.0F).wall_ratio, 7.0 * std::exp(-2.0 * depth), 1e-5);
  EXPECT_EQ(Pass(11.0, 0.5F, 4.0F).wall_ratio, 7.0F);
  EXPECT_LT(Pass(11.0, 0.0F, 4.0F).wall_ratio, 7.0F);
}

double DepthTo(double range_m) {
  if (range_m > 30.0) return 0.1 * (4.0 * (1.0 - std::exp(-5.0)) + std::min(range_m, 40.0) - 30.0);
  return 0.4 * (std::exp(-(30.0 - range_m) / 4.0) - std::exp(-5.0));
}

TEST(Spray, ReturnsFromWhereLightIsScatteredBack) {
  for (const double wall_m : {60.0, 33.0}) {
    std::vector<double> shares;
    for (const double range_m : Pass(wall_m).ranges_m) {
      shares.push_back(std::expm1(-2.0 * DepthTo(range_m)) / std::expm1(-2.0 * DepthTo(wall_m)));
    }
    ASSERT_EQ(shares.size(), 1U << 16U);
    std::sort(shares.begin(), shares.end());
    double most = 0.0;
    for (std::size_t i = 0; i < shares.size(); ++i) {
      const double rank = (static_cast<double>(i) + 0.5) / static_cast<double>(shares.size());
      most = std::max(most, std::abs(shares[i] - rank));
    }
    EXPECT_LT(most, 1.95 / 256.0);  // Kolmogorov and Smirnov's limit at one in a thousand.
  }
}

TEST(Spray, ScattersLikeAVolumeWhoseDensityFluctuatesExponentially) {
  const Passed passed = Pass(60.0);
  const double per_extinction = std::numbers::pi / 65.0 * PulseLength_m(InSpray().beam);
  double mean = 0.0;
  double square = 0.0;
  for (std::size_t i = 0; i < passed.ranges_m.size(); ++i) {
    const double extinction = 0.1 * std::exp(-std::max(30.0 - passed.ranges_m[i], 0.0) / 4.0);
    const double clump = passed.intensities[i] / (per_extinction * extinction);
    mean += clump / static_cast<double>(passed.ranges_m.size());
    square += clump * clump / static_cast<double>(passed.ranges_m.size());
  }
  // The exponential distribution's standard deviation is 1, that of its square sqrt(20).
  EXPECT_NEAR(mean, 1.0, 4.0 / 256.0);
  EXPECT_NEAR(square, 2.0, 4.0 * std::sqrt(20.0) / 256.0);
}

TEST(Spray, IsNotSeenThroughASurfaceInFrontOrTheVehicle) {
  EXPECT_TRUE(Pass(9.0).ranges_m.empty());
  EchoTiles echoes;
  FillHits({.range_m = [](std::uint32_t) { return 60.0; }}, 0, echoes);
  std::fill_n(echoes.first.outcome, kTileSize, static_cast<std::uint32_t>(Outcome::kEgo));
  Spray(InSpray()).Apply(*RaysAhead(), {CloudAhead()}, Detector(InSpray()), echoes);
  EXPECT_EQ(echoes.num_more(), 0U);
}

}  // namespace
}  // namespace railcast
