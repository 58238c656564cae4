#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "core/detect/base/beam_optics.h"
#include "core/detect/kernels/echo_power.h"
#include "core/detect/kernels/measurement.h"
#include "tests/core/detect/facing_beams.h"

namespace railcast {
namespace {

constexpr std::uint32_t kNumDraws = 1U << 18U;
constexpr DetectionParameters kParameters{.seed = 11, .snr_at_threshold = 5.0F};

// Counts how many of kNumDraws firings with that power are detected.
template <bool kIsSmooth>
double CountDetected(float power_ratio) {
  auto tile = std::make_unique<DetectTile>();
  tile->num_rays = kTileSize;
  double count = 0.0;
  for (std::uint32_t begin = 0; begin < kNumDraws; begin += kTileSize) {
    for (std::uint32_t i = 0; i < kTileSize; ++i) {
      tile->firing[i] = begin + i;
      tile->power_ratio[i] = power_ratio;
      tile->outcome[i] = static_cast<std::uint32_t>(Outcome::kReturned);
    }
    baseline::ApplyDetection<kIsSmooth>(*tile, kParameters);
    for (std::size_t i = 0; i < kTileSize; ++i) {
      count += tile->outcome[i] == static_cast<std::uint32_t>(Outcome::kReturned) ? 1.0 : 0.0;
    }
  }
  return count;
}

TEST(Detection, ProbabilityIsThatOfNoiseOfTheAmplitudesOwnSize) {
  for (const double ratio : {0.5, 0.8, 1.0, 1.2, 1.5}) {
    const double p = 0.5 * std::erfc(-5.0 * (ratio - 1.0) / std::sqrt(2.0));
    EXPECT_NEAR(CountDetected<true>(static_cast<float>(ratio)), p * kNumDraws,
                4.0 * std::sqrt(p * (1.0 - p) * kNumDraws))
        << ratio;
  }
}

TEST(Detection, IsCertainFarAboveTheThresholdAndNeverHappensWithoutPower) {
  EXPECT_EQ(CountDetected<true>(1e30F), kNumDraws);
  EXPECT_EQ(CountDetected<true>(std::numeric_limits<float>::quiet_NaN()), 0.0);
  // Phi(-5) = 2.9e-7: one in three and a half million.
  EXPECT_LE(CountDetected<true>(0.0F), 1.0);
}

TEST(Detection, IsHardWithoutTheProbability) {
  EXPECT_EQ(CountDetected<false>(1.0F), kNumDraws);
  EXPECT_EQ(CountDetected<false>(std::nextafter(1.0F, 0.0F)), 0.0);
  EXPECT_EQ(CountDetected<false>(std::numeric_limits<float>::quiet_NaN()), 0.0);
}

TEST(Detection, LosesClutterTooAndLeavesOtherOutcomesAlone) {
  DetectTile tile{};
  const Outcome before[] = {Outcome::kClutter, Outcome::kEgo, Outcome::kNoSurface,
                            Outcome::kSensorDropout};
  tile.num_rays = 4;
  for (std::size_t i = 0; i < 4; ++i) tile.outcome[i] = static_cast<std::uint32_t>(before[i]);
  baseline::ApplyDetection<false>(tile, kParameters);
  EXPECT_EQ(static_cast<Outcome>(tile.outcome[0]), Outcome::kBelowThreshold);
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_EQ(static_cast<Outcome>(tile.outcome[i]), before[i]);
  }
}

TEST(Sunlight, RaisesTheThresholdByTheRootOfTheBackground) {
  DetectTile tile{};
  tile.num_rays = 2;
  tile.power_ratio[0] = tile.power_ratio[1] = 4.0F;
  tile.reflectivity[0] = 0.8F;
  tile.reflectivity[1] = 0.0F;  // A drop with no surface behind it.
  baseline::ApplySunlight(tile, {.background_gain = 3.0F});
  EXPECT_FLOAT_EQ(tile.power_ratio[0], 4.0F / std::sqrt(3.4F));
  EXPECT_EQ(tile.power_ratio[1], 4.0F);
}

// Tests range noise and channel bias with the whole detector.

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

/// The factors by which intensities of 0.5 are measured wrong, by firing.
std::vector<double> FactorsOfIntensity(const DetectorSpec& spec,
                                       std::uint32_t frame,
                                       std::uint32_t firings_per_channel,
                                       double range_m = 16.0) {
  FacingBeams beams{.frame = frame};
  beams.range_m = [=](std::uint32_t) { return range_m; };
  beams.channel = [=](std::uint32_t firing) { return firing / firings_per_channel; };
  beams.num_channels = beams.num_firings / firings_per_channel;
  std::vector<double> factors;
  for (const FacingEcho& echo : DetectFacing(spec, beams)) {
    factors.push_back(static_cast<double>(echo.intensity) / 0.5);
  }
  return factors;
}

// 4 standard errors of the mean, and of the variance of a log-normal law.
void ExpectFactors(const std::vector<double>& factors, double relative_sigma) {
  const double variance = relative_sigma * relative_sigma;
  const double w = 1.0 + variance;
  const double kurtosis = std::pow(w, 4) + 2.0 * std::pow(w, 3) + 3.0 * w * w - 3.0;
  const auto num = static_cast<double>(factors.size());
  double mean = 0.0;
  double square = 0.0;
  for (const double factor : factors) mean += factor / num;
  for (const double factor : factors) square += (factor - mean) * (factor - mean) / num;
  EXPECT_NEAR(mean, 1.0, 4.0 * relative_sigma / std::sqrt(num));
  EXPECT_NEAR(square / variance, 1.0, 4.0 * std::sqrt((kurtosis - 1.0) / num));
}

TEST(IntensityNoise, HasTheStatedSpreadFromEchoToEchoAndKeepsTheMean) {
  DetectorSpec spec{.seed = 1, .effects = {.intensity_noise = true}};
  for (const double sigma : {0.09, 0.5}) {
    spec.receiver.intensity_noise = sigma;
    ExpectFactors(FactorsOfIntensity(spec, 0, 256), sigma);
  }
  EXPECT_NE(FactorsOfIntensity(spec, 1, 256), FactorsOfIntensity(spec, 0, 256));
}

TEST(IntensityNoise, LeavesPowerAndRangeAsTheyAre) {
  FacingBeams beams{.num_firings = kTileSize};
  beams.range_m = [](std::uint32_t firing) { return 16.0 + firing; };
  DetectorSpec spec{.effects = EffectsOfRung(Fidelity::kSurface)};
  const auto exact = DetectFacing(spec, beams);
  spec.receiver.intensity_noise = spec.receiver.channel_gain = 0.2;
  const auto noisy = DetectFacing(spec, beams);
  ASSERT_EQ(noisy.size(), exact.size());
  for (std::size_t i = 0; i < exact.size(); ++i) {
    FacingEcho same = noisy[i];
    EXPECT_NE(same.intensity, exact[i].intensity);
    same.intensity = exact[i].intensity;
    EXPECT_EQ(same, exact[i]);
  }
}

TEST(ChannelGain, IsTheSameInEveryFrameAndAnotherForEachChannelAndSensor) {
  DetectorSpec spec{.seed = 1, .effects = {.channel_gain = true}};
  spec.receiver.channel_gain = 0.14;
  const auto factors = FactorsOfIntensity(spec, 0, 1);
  ExpectFactors(factors, 0.14);
  EXPECT_EQ(FactorsOfIntensity(spec, 77, 1), factors);
  const auto of_few = FactorsOfIntensity(spec, 0, 1024);
  for (std::size_t i = 0; i < of_few.size(); ++i) EXPECT_EQ(of_few[i], factors[i / 1024]);
  spec.seed = 2;
  EXPECT_NE(FactorsOfIntensity(spec, 0, 1), factors);
}

TEST(ChannelGain, ByRangeHasTheStatedSpreadAtEachRange) {
  DetectorSpec spec{.seed = 1, .effects = {.channel_gain = true}};
  spec.receiver.channel_gain_variation = 0.18;
  for (const double range_m : {0.7, 16.0, 190.0}) {
    ExpectFactors(FactorsOfIntensity(spec, 0, 1, range_m), 0.18);
  }
  EXPECT_EQ(FactorsOfIntensity(spec, 77, 1), FactorsOfIntensity(spec, 0, 1));
  spec.receiver.channel_gain = 0.14;
  const double product = (1.0 + 0.14 * 0.14) * (1.0 + 0.18 * 0.18);  // They are independent.
  ExpectFactors(FactorsOfIntensity(spec, 0, 1), std::sqrt(product - 1.0));
}

TEST(ChannelGain, OfOneChannelAtTwoRangesIsAlikeByTheirRatio) {
  DetectorSpec spec{.seed = 1, .effects = {.channel_gain = true}};
  spec.receiver.channel_gain = 0.1;
  spec.receiver.channel_gain_variation = 0.2;
  const double g2 = std::log1p(0.1 * 0.1);
  const double h2 = std::log1p(0.2 * 0.2);
  const std::vector<double> near = FactorsOfIntensity(spec, 0, 1, 10.0);
  for (const double ratio : {1.0, 1.2, 1.5, 2.0, 8.0}) {
    const std::vector<double> far = FactorsOfIntensity(spec, 0, 1, 10.0 * ratio);
    const auto num = static_cast<double>(near.size());
    double covariance = 0.0;  // Of logarithms, whose mean is -(g^2 + h^2) / 2.
    for (std::size_t i = 0; i < near.size(); ++i) {
      const double mean = -0.5 * (g2 + h2);
      covariance += (std::log(near[i]) - mean) * (std::log(far[i]) - mean) / num;
    }
    const double x = std::log(ratio) / kGainLogRange;
    // Products of n at two ranges have fourth moments of at most 3.
    EXPECT_NEAR(covariance, g2 + h2 * std::exp(-0.5 * x * x),
                4.0 * (g2 + h2) * std::sqrt(3.0 / num))
        << ratio;
  }
}

/// The share of beams that are lost which meet surfaces of these shares, `jump_m` apart.
double ShareLostAtEdge(float near_share, float far_share, float jump_m) {
  constexpr std::uint32_t kNumBeams = 1U << 16U;
  const EdgeLossParameters parameters{.seed = 9, .probability = 0.6F, .pulse_length_m = 0.75F};
  auto echoes = std::make_unique<EchoTiles>();
  double num_lost = 0.0;
  FacingBeams beams;
  beams.range_m = [](std::uint32_t) { return 20.0; };
  for (std::uint32_t begin = 0; begin < kNumBeams; begin += kTileSize) {
    FillHits(beams, begin, *echoes);
    for (std::uint32_t i = 0; i < kTileSize; ++i) {
      echoes->first.share[i] = near_share;
      const auto [tile, lane] = echoes->Add(i, 1);
      tile.surface[lane] = 2;
      tile.clutter[lane] = kNoClutter;
      tile.outcome[lane] = static_cast<std::uint32_t>(Outcome::kReturned);
      tile.share[lane] = far_share;
      tile.true_range_m[lane] = 20.0F + jump_m;
    }
    LoseBeamsAtEdges(parameters, *echoes);
    for (std::uint32_t i = 0; i < kTileSize; ++i) {
      const auto [tile, lane] = echoes->more(i);
      const std::uint32_t outcome = echoes->first.outcome[i];
      EXPECT_EQ(tile.outcome[lane], outcome) << "a beam is lost as a whole";
      num_lost += outcome == static_cast<std::uint32_t>(Outcome::kSensorDropout) ? 1.0 : 0.0;
    }
  }
  return num_lost / kNumBeams;
}

TEST(EdgeLoss, GrowsWithTheSmallerShareAndTheJumpBeyondThePulse) {
  const auto expect = [](float near_share, float far_share, float jump_m, double p) {
    EXPECT_NEAR(ShareLostAtEdge(near_share, far_share, jump_m), p,
                4.0 * std::sqrt(p * (1.0 - p) / (1U << 16U)))
        << near_share << " " << far_share << " " << jump_m;
  };
  expect(0.5F, 0.5F, 7.5F, 0.6 * 0.9);
  expect(0.2F, 0.8F, 7.5F, 0.6 * 0.9 * 0.4);
  expect(0.8F, 0.2F, 7.5F, 0.6 * 0.9 * 0.4);
  expect(0.3F, 0.3F, 1.5F, 0.6 * 0.5);
  expect(0.5F, 0.5F, 0.75F, 0.0);
  expect(0.5F, 0.5F, 0.1F, 0.0);
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

// Behind a covered window, for example. With a noise that does not hang on the power there is none.
TEST(Measurement, OfAnEchoWithoutPowerIsAPointWithARangeOrNone) {
  const float bias_m = 0.0F;
  for (const float scale_m : {0.0F, 0.1F}) {
    DetectTile tile{};
    tile.num_rays = kTileSize;
    for (std::uint32_t i = 0; i < kTileSize; ++i) {
      tile.firing[i] = i;
      tile.true_range_m[i] = 20.0F;
    }
    baseline::ApplyMeasurement<RangeErrors::kSignal>(tile, {.range_max_m = 100.0F,
                                                            .scale_m = scale_m,
                                                            .snr_at_threshold = 5.0F,
                                                            .channel_bias_m = &bias_m});
    for (std::uint32_t i = 0; i < kTileSize; ++i) {
      const bool has_point = tile.outcome[i] == static_cast<std::uint32_t>(Outcome::kReturned);
      EXPECT_EQ(std::isfinite(tile.range_m[i]), has_point);
      EXPECT_EQ(has_point, scale_m == 0.0F);
    }
  }
}

// The power of an echo at R is (R_t / R)^2 of the threshold, with R_t = 447.2 m for 50 %.
TEST(RangeWalk, AddsTheInverseOfThePowerRatioUpToTheThreshold) {
  FacingBeams beams{.num_firings = kTileSize};
  beams.range_m = [](std::uint32_t firing) { return 5.0 + 1.7 * firing; };
  DetectorSpec spec{.range_max_m = 1000.0, .effects = {.detection = true, .range_walk = true}};
  spec.receiver.range_walk_m = 0.3;
  const double threshold_m = 200.0 * std::sqrt(5.0);
  for (const FacingEcho& echo : DetectFacing(spec, beams)) {
    if (echo.outcome != Outcome::kReturned) continue;
    const auto true_range_m = static_cast<double>(echo.true_range_m);
    const double error_m = static_cast<double>(echo.range_m) - true_range_m;
    // float32 has steps of 3e-5 m there.
    EXPECT_NEAR(error_m, 0.3 * std::pow(true_range_m / threshold_m, 2), 6e-5) << true_range_m;
  }
}

TEST(RangeWalk, IsNoMoreThanAtTheThresholdForEchoesThatNoiseLifts) {
  FacingBeams beams{.num_firings = 1U << 12U};
  beams.range_m = [](std::uint32_t) { return 470.0; };  // Power ratio 0.905.
  DetectorSpec spec{
      .range_max_m = 1000.0,
      .effects = {.detection = true, .detection_probability = true, .range_walk = true}};
  spec.receiver.range_walk_m = 0.3;
  std::size_t num = 0;
  for (const FacingEcho& echo : DetectFacing(spec, beams)) {
    if (echo.outcome != Outcome::kReturned) continue;
    EXPECT_NEAR(echo.range_m, 470.3F, 6e-5F);
    ++num;
  }
  EXPECT_GT(num, 500U);
}

constexpr float kSaturation = 100.0F;

DetectorSpec Saturating() {
  DetectorSpec spec{.range_max_m = 1000.0, .effects = {.detection = true, .saturation = true}};
  spec.receiver.saturation_power_ratio = static_cast<double>(kSaturation);
  return spec;
}

// The power of an echo at R is (R_t / R)^2 of the threshold, with R_t = 447.2 m for 50 %.
TEST(Saturation, ClipsThePowerRatioAndNothingElse) {
  FacingBeams beams{.num_firings = kTileSize};
  beams.range_m = [](std::uint32_t firing) { return 5.0 + 1.7 * firing; };
  DetectorSpec spec = Saturating();
  const auto clipped = DetectFacing(spec, beams);
  spec.receiver.saturation_power_ratio.reset();
  const auto all = DetectFacing(spec, beams);
  const double threshold_m = 200.0 * std::sqrt(5.0);
  std::size_t num_clipped = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double ratio = std::pow(threshold_m / static_cast<double>(all[i].true_range_m), 2);
    const double expected = std::min(ratio, static_cast<double>(kSaturation));
    EXPECT_NEAR(static_cast<double>(clipped[i].power_ratio), expected, 1e-5 * expected);
    EXPECT_EQ(clipped[i].range_m, all[i].range_m);
    EXPECT_EQ(clipped[i].intensity, all[i].intensity);
    EXPECT_EQ(clipped[i].outcome, all[i].outcome);
    num_clipped += ratio > static_cast<double>(kSaturation) ? 1 : 0;
  }
  EXPECT_EQ(num_clipped, 24U) << "up to 44.7 m";
}

// At its ends a Gaussian pulse of peak p has fallen to 1.
TEST(Saturation, GivesTheLengthOverWhichAGaussianPulseIsAboveTheThreshold) {
  const auto tile = std::make_unique<DetectTile>();
  tile->num_rays = kTileSize;
  const auto sigma_m = static_cast<float>(PulseSigma_m(BeamSpec{}));
  for (std::size_t i = 0; i < kTileSize; ++i) {
    tile->power_ratio[i] = std::pow(1.08F, static_cast<float>(i) - 20.0F);
  }
  tile->power_ratio[7] = std::numeric_limits<float>::quiet_NaN();
  const auto power_ratio = std::make_unique<DetectTile>(*tile);
  AvailableKernels().back().saturation(*tile, {kSaturation, sigma_m});
  for (std::size_t i = 0; i < kTileSize; ++i) {
    const float ratio = power_ratio->power_ratio[i];
    if (!(ratio > 1.0F)) {
      EXPECT_EQ(tile->busy_m[i], 0.0F);
      continue;
    }
    const float z = tile->busy_m[i] / sigma_m;
    // The exponent is at most 19, of which float32 keeps 1e-6.
    EXPECT_NEAR(ratio * std::exp(-0.5F * z * z), 1.0F, 2e-5F) << ratio;
  }
  EXPECT_TRUE(std::isnan(tile->power_ratio[7]));
}

TEST(Saturation, ComesAfterRangeWalkAndBeforeRangeNoise) {
  FacingBeams beams{.num_firings = 1U << 14U};
  beams.range_m = [](std::uint32_t) { return 2.0; };  // Power ratio 50,000.
  DetectorSpec spec = Saturating();
  spec.effects.range_walk = spec.effects.range_noise = true;
  spec.receiver.range_walk_m = 10.0;
  spec.receiver.range_noise_floor_m = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for (const FacingEcho& echo : DetectFacing(spec, beams)) {
    const double error_m = static_cast<double>(echo.range_m) - 2.0;
    sum += error_m;
    squares += error_m * error_m;
  }
  const auto num = static_cast<double>(beams.num_firings);
  // The SNR is 5 at the threshold. The relative error of a variance is sqrt(2 / num).
  const double variance = 0.1 * 0.1 / (2.0 * 5.0 * static_cast<double>(kSaturation));
  EXPECT_NEAR(squares / num, variance, 4.0 * variance * std::sqrt(2.0 / num));
  EXPECT_NEAR(sum / num, 10.0 / 50'000.0, 4.0 * std::sqrt(variance / num));
}

}  // namespace
}  // namespace railcast
