// Tests range noise and channel bias with the whole detector.
#include "core/detect/kernels/measurement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/core/detect/facing_beams.h"

namespace railcast {
namespace {

// Standard deviation of the measured range where the power ratio is `ratio`.
double NoiseAt_m(double ratio) {
  const DetectorSpec spec{.range_min_m = 0.0, .range_max_m = 1e4, .effects = {.range_noise = true}};
  // At normal incidence with rho 0.5 and R0 200 m, ratio = 5 (200 / r)^2.
  const double range_m = 200.0 * std::sqrt(5.0 / ratio);
  FacingBeams beams;
  beams.num_firings = 1U << 15U;
  beams.range_m = [&](std::uint32_t) { return range_m; };
  double squares = 0.0;
  for (const FacingEcho& echo : DetectFacing(spec, beams)) {
    EXPECT_NEAR(static_cast<double>(echo.power_ratio) / ratio, 1.0, 1e-4);
    squares += std::pow(static_cast<double>(echo.range_m - echo.true_range_m), 2);
  }
  return std::sqrt(squares / beams.num_firings);
}

// Four standard errors of the standard deviation of 2^15 normal deviates: 4 / sqrt(2 x 2^15) = 1.6
// %.
constexpr double kRelative = 0.016;

TEST(RangeNoise, FollowsTheSignalToNoiseRatio) {
  for (const double ratio : {1e5, 100.0, 10.0, 2.0, 1.0}) {
    const double sigma_m = std::hypot(0.015, 0.1 / std::sqrt(2.0 * 5.0 * ratio));
    EXPECT_NEAR(NoiseAt_m(ratio) / sigma_m, 1.0, kRelative) << ratio;
  }
}

// docs/physics.md 5: 1.5 cm on a near wall, 3.2 to 5 cm at the threshold.
TEST(RangeNoise, HasThePublishedSizeNearAndFar) {
  EXPECT_NEAR(NoiseAt_m(1e5), 0.015, 0.05 * 0.015);
  const double far_m = NoiseAt_m(1.0);
  EXPECT_GT(far_m, 0.032);
  EXPECT_LT(far_m, 0.05);
}

std::vector<double> BiasOfChannels(std::uint32_t num_channels,
                                   std::uint32_t frame,
                                   std::uint64_t seed) {
  const DetectorSpec spec{.seed = seed, .effects = {.channel_bias = true}};
  FacingBeams beams;
  beams.frame = frame;
  beams.num_firings = num_channels;
  beams.num_channels = num_channels;
  beams.range_m = [](std::uint32_t) { return 16.0; };
  beams.channel = [](std::uint32_t firing) { return firing; };
  std::vector<double> bias_m;
  for (const FacingEcho& echo : DetectFacing(spec, beams)) {
    bias_m.push_back(static_cast<double>(echo.range_m - echo.true_range_m));
  }
  return bias_m;
}

TEST(ChannelBias, IsTheSameInEveryFrameAndAnotherForEachSeed) {
  const auto bias_m = BiasOfChannels(256, 0, 1);
  EXPECT_EQ(BiasOfChannels(256, 77, 1), bias_m);
  EXPECT_NE(BiasOfChannels(256, 0, 2), bias_m);
}

TEST(ChannelBias, IsNormalOverTheChannels) {
  constexpr std::uint32_t kNumChannels = 1U << 14U;
  std::vector<double> bias_m = BiasOfChannels(kNumChannels, 0, 1);
  std::sort(bias_m.begin(), bias_m.end());
  double worst = 0.0;
  for (std::size_t i = 0; i < bias_m.size(); ++i) {
    const double cdf = 0.5 * std::erfc(-bias_m[i] / 0.01 / std::sqrt(2.0));
    worst = std::max({worst, std::abs(cdf - static_cast<double>(i) / kNumChannels),
                      std::abs(cdf - static_cast<double>(i + 1) / kNumChannels)});
  }
  // The Kolmogorov-Smirnov distance exceeds 1.95 / sqrt(n) in one case of 1000.
  EXPECT_LE(worst, 1.95 / std::sqrt(kNumChannels));
}

TEST(Measurement, ReportsWhereTheEchoPeaksNotWhereTheSurfaceIs) {
  DetectTile tile{};
  tile.num_rays = 1;
  tile.direction_x[0] = 1.0F;
  tile.true_range_m[0] = 20.0F;
  tile.peak_shift_m[0] = 0.25F;
  tile.power_ratio[0] = 10.0F;
  const float bias_m = 0.0F;
  baseline::ApplyMeasurement<RangeErrors::kSignal>(
      tile, {.range_max_m = 100.0F, .snr_at_threshold = 5.0F, .channel_bias_m = &bias_m});
  EXPECT_EQ(tile.range_m[0], 20.25F);
  EXPECT_EQ(tile.x[0], 20.25F);
  EXPECT_EQ(tile.true_range_m[0], 20.0F);
}

}  // namespace
}  // namespace railcast
