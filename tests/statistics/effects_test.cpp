// Compares every effect of the plausibility rung with its closed form, over 2^20 firings.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "core/detect/detector/detector.h"
#include "railcast/outcome.h"
#include "railcast/transform.h"

namespace railcast {
namespace {

constexpr std::uint32_t kNumFirings = 1U << 20U;

/// The answer to one firing.
struct Answer {
  Outcome outcome;
  double true_range_m, range_m, x, y, z;
  float intensity, power_ratio;
};

/// Sends kNumFirings beams along (0.6, 0.64, 0.48) at surfaces of reflectivity 0.5 that face them,
/// at `range_m(i)`; NaN: no surface.
std::vector<Answer> Detect(const DetectorSpec& spec,
                           const std::function<double(std::uint32_t)>& range_m) {
  const Detector detector(spec);
  auto echoes = std::make_unique<EchoTiles>();
  const auto rays = std::make_unique<RayTile>();  // Only fog would need them.
  DetectTile* const tile = &echoes->first;
  std::vector<Answer> answers;
  answers.reserve(kNumFirings);
  for (std::uint32_t first = 0; first < kNumFirings; first += kTileSize) {
    tile->num_rays = kTileSize;
    tile->frame = 1;
    for (std::uint32_t i = 0; i < kTileSize; ++i) {
      const double range = range_m(first + i);
      tile->firing[i] = first + i;
      tile->direction_x[i] = 0.6F;
      tile->direction_y[i] = 0.64F;
      tile->direction_z[i] = 0.48F;
      tile->true_range_m[i] = static_cast<float>(range);
      tile->echo[i] = 0;
      tile->share[i] = 1.0F;
      tile->cos_incidence[i] = 1.0F;
      tile->reflectivity[i] = 0.5F;
      tile->outcome[i] =
          static_cast<std::uint32_t>(std::isnan(range) ? Outcome::kNoSurface : Outcome::kReturned);
    }
    detector.Detect({*rays, Transform::Identity(), 0.0}, *echoes);
    for (std::uint32_t i = 0; i < kTileSize; ++i) {
      answers.push_back({static_cast<Outcome>(tile->outcome[i]),
                         static_cast<double>(tile->true_range_m[i]),
                         static_cast<double>(tile->range_m[i]), static_cast<double>(tile->x[i]),
                         static_cast<double>(tile->y[i]), static_cast<double>(tile->z[i]),
                         tile->intensity[i], tile->power_ratio[i]});
    }
  }
  return answers;
}

double SpreadOverRange(std::uint32_t firing) {
  return 300.0 * (firing + 0.5) / kNumFirings;
}

std::size_t Count(const std::vector<Answer>& answers, Outcome outcome) {
  return static_cast<std::size_t>(std::count_if(
      answers.begin(), answers.end(), [&](const Answer& a) { return a.outcome == outcome; }));
}

// rho exp(-fog R) = T (R / R_ref)^2 has one solution: every beam beyond it is lost, and none before
// it.
TEST(Threshold, DropsExactlyTheBeamsBeyondTheRangeOfTheClosedForm) {
  for (const double fog_per_m : {0.0, 0.005, 0.02}) {
    DetectorSpec spec{.effects = {.threshold = true}};
    spec.plausibility.reference_range_m = 100.0;
    spec.weather.fog_density_per_m = fog_per_m;
    double near_m = 0.0;
    double far_m = 1000.0;
    while (far_m - near_m > 1e-9) {
      const double r = 0.5 * (near_m + far_m);
      const bool detected = 0.5 * std::exp(-fog_per_m * r) >= 0.1 * std::pow(r / 100.0, 2);
      (detected ? near_m : far_m) = r;
    }
    const auto answers = Detect(spec, SpreadOverRange);
    for (const Answer& answer : answers) {
      // Rounding of float32 at the limit.
      if (std::abs(answer.true_range_m - near_m) < 1e-3) continue;
      if (answer.true_range_m < spec.range_min_m) continue;
      ASSERT_EQ(answer.outcome,
                answer.true_range_m < near_m ? Outcome::kReturned : Outcome::kBelowThreshold);
    }
  }
}

TEST(RainDropout, SurvivalFallsExponentiallyWithRangeInEveryBin) {
  DetectorSpec spec{.seed = 3, .effects = {.rain = true}};
  spec.weather.rain_rate_mmph = 25.0;
  const double rate_per_m = 3.65e-4 * std::pow(25.0, 0.63);
  constexpr std::size_t kBins = 15;
  std::array<double, kBins> lost{};
  std::array<double, kBins> count{};
  std::array<double, kBins> expected{};
  std::array<double, kBins> variance{};
  for (const Answer& answer : Detect(spec, SpreadOverRange)) {
    if (answer.outcome == Outcome::kNearRange) continue;
    const auto bin = static_cast<std::size_t>(answer.true_range_m / 20.0);
    const double p = 1.0 - std::exp(-rate_per_m * answer.true_range_m);
    count[bin] += 1.0;
    lost[bin] += answer.outcome == Outcome::kRainAbsorbed ? 1.0 : 0.0;
    expected[bin] += p;
    variance[bin] += p * (1.0 - p);
  }
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    // Four standard deviations are exceeded with a probability of 6e-5 per bin; the seed is fixed.
    EXPECT_NEAR(lost[bin], expected[bin], 4.0 * std::sqrt(variance[bin])) << "bin " << bin;
    EXPECT_GT(count[bin], 60'000.0);
  }
}

TEST(RainDropout, LeavesEverythingAloneWithoutRain) {
  const auto answers = Detect({.effects = {.rain = true}}, SpreadOverRange);
  EXPECT_EQ(Count(answers, Outcome::kRainAbsorbed), 0U);
}

// The sample standard deviation of n normal values is within a relative 4 / sqrt(2 n) of the truth.
TEST(Noise, IsotropicSigmaGrowsLinearlyWithRange) {
  constexpr double kRanges_m[] = {10.0, 50.0, 100.0, 200.0, 280.0};
  DetectorSpec spec{.effects = {.noise = true}};
  spec.plausibility.noise_sigma0_m = 0.01;
  spec.plausibility.noise_sigma1 = 3e-4;
  const auto answers = Detect(spec, [&](std::uint32_t i) { return kRanges_m[i % 5]; });
  for (std::size_t k = 0; k < 5; ++k) {
    const double sigma_m = 0.01 + 3e-4 * kRanges_m[k];
    Vector3 sum = Vector3::Zero();
    Vector3 squares = Vector3::Zero();
    double n = 0.0;
    for (std::size_t i = k; i < answers.size(); i += 5, n += 1.0) {
      const Vector3 truth = answers[i].true_range_m * Vector3(0.6, 0.64, 0.48);
      const Vector3 noise = Vector3(answers[i].x, answers[i].y, answers[i].z) - truth;
      sum += noise;
      squares += noise.cwiseAbs2();
      ASSERT_NEAR(answers[i].range_m, Vector3(answers[i].x, answers[i].y, answers[i].z).norm(),
                  1e-4);
    }
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(sum(axis) / n, 0.0, 4.0 * sigma_m / std::sqrt(n));
      EXPECT_NEAR(std::sqrt(squares(axis) / n) / sigma_m, 1.0, 4.0 / std::sqrt(2.0 * n));
    }
  }
}

TEST(Noise, AlongTheBeamMovesThePointOnlyAlongIt) {
  constexpr double kRanges_m[] = {10.0, 50.0, 100.0, 200.0, 280.0};
  DetectorSpec spec{.effects = {.noise = true}};
  spec.plausibility.noise_sigma0_m = 0.02;
  spec.plausibility.noise_sigma1 = 1e-4;
  spec.plausibility.noise_shape = NoiseShape::kBeam;
  const auto answers = Detect(spec, [&](std::uint32_t i) { return kRanges_m[i % 5]; });
  for (std::size_t k = 0; k < 5; ++k) {
    const double sigma_m = 0.02 + 1e-4 * kRanges_m[k];
    double squares = 0.0;
    double n = 0.0;
    for (std::size_t i = k; i < answers.size(); i += 5, n += 1.0) {
      const Vector3 point(answers[i].x, answers[i].y, answers[i].z);
      ASSERT_NEAR((point - answers[i].range_m * Vector3(0.6, 0.64, 0.48)).norm(), 0.0, 1e-4);
      squares += std::pow(answers[i].range_m - answers[i].true_range_m, 2);
    }
    EXPECT_NEAR(std::sqrt(squares / n) / sigma_m, 1.0, 4.0 / std::sqrt(2.0 * n));
  }
}

DetectorSpec SnowSpec() {
  DetectorSpec spec{.range_min_m = 0.0, .effects = {.snow = true}};
  spec.weather.snow_rate_mmph = 2.0;
  spec.weather.snow_echoes_per_mmph = 0.4;
  spec.weather.snow_range_scale_m = 6.0;
  return spec;
}

// Returns the distribution function of the Maxwell distribution of scale a.
double MaxwellCdf(double r, double a) {
  return std::erf(r / (a * std::numbers::sqrt2)) -
         std::sqrt(2.0 / std::numbers::pi) * r / a * std::exp(-r * r / (2.0 * a * a));
}

TEST(SnowClutter, InjectsIntoEmptyBeamsWithMaxwellRanges) {
  const auto answers = Detect(SnowSpec(), [](std::uint32_t) { return std::nan(""); });
  std::vector<double> ranges_m;
  for (const Answer& answer : answers) {
    if (answer.outcome == Outcome::kClutter) ranges_m.push_back(answer.range_m);
  }
  const double n = kNumFirings;
  const double p = 1.0 - std::exp(-0.8);
  EXPECT_NEAR(static_cast<double>(ranges_m.size()), n * p, 4.0 * std::sqrt(n * p * (1.0 - p)));
  // Kolmogorov-Smirnov test: 1.95 / sqrt(n) is exceeded once in a thousand.
  std::sort(ranges_m.begin(), ranges_m.end());
  const auto m = static_cast<double>(ranges_m.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < ranges_m.size(); ++i) {
    const double cdf = MaxwellCdf(ranges_m[i], 6.0);
    worst = std::max({worst, std::abs(cdf - static_cast<double>(i) / m),
                      std::abs(cdf - static_cast<double>(i + 1) / m)});
  }
  EXPECT_LE(worst, 1.95 / std::sqrt(m));
}

TEST(SnowClutter, HasNoPowerWithoutTheThresholdAndIsSubjectToItWithIt) {
  for (const bool threshold : {false, true}) {
    DetectorSpec spec = SnowSpec();
    spec.effects.threshold = threshold;
    // Flakes are detectable up to sqrt(0.02 / 0.1) * 10 m = 4.47 m.
    spec.plausibility.reference_range_m = 10.0;
    double farthest_m = 0.0;
    for (const Answer& answer : Detect(spec, [](std::uint32_t) { return std::nan(""); })) {
      if (answer.outcome != Outcome::kClutter) continue;
      farthest_m = std::max(farthest_m, answer.range_m);
      ASSERT_EQ(std::isnan(answer.intensity), !threshold);
      ASSERT_EQ(std::isnan(answer.power_ratio), !threshold);
    }
    EXPECT_EQ(farthest_m <= 10.0 * std::sqrt(0.2), threshold);
  }
}

TEST(SnowClutter, ReplacesOnlyReturnsFartherThanTheFlake) {
  constexpr double kWall_m = 9.0;
  const auto answers = Detect(SnowSpec(), [](std::uint32_t) { return kWall_m; });
  const double n = kNumFirings;
  const double p = (1.0 - std::exp(-0.8)) * MaxwellCdf(kWall_m, 6.0);
  EXPECT_NEAR(static_cast<double>(Count(answers, Outcome::kClutter)), n * p,
              4.0 * std::sqrt(n * p * (1.0 - p)));
  for (const Answer& answer : answers) ASSERT_LE(answer.true_range_m, kWall_m);
}

TEST(SensorDropout, MissesTheStatedShareWhateverTheRange) {
  DetectorSpec spec{.effects = {.sensor_dropout = true}};
  spec.plausibility.dropout_probability = 0.18;
  const auto answers = Detect(spec, SpreadOverRange);
  const double n = kNumFirings;
  EXPECT_NEAR(static_cast<double>(Count(answers, Outcome::kSensorDropout)), 0.18 * n,
              4.0 * std::sqrt(n * 0.18 * 0.82));
}

TEST(SensorDropout, GrowsExponentiallyWithRange) {
  DetectorSpec spec{.effects = {.sensor_dropout = true}};
  spec.plausibility.dropout_probability = 0.1;
  spec.plausibility.dropout_per_m = 2e-3;
  const double n = kNumFirings;
  for (const double range_m : {10.0, 100.0, 250.0}) {
    const auto answers = Detect(spec, [=](std::uint32_t) { return range_m; });
    const double lost = 1.0 - 0.9 * std::exp(-2e-3 * range_m);
    EXPECT_NEAR(static_cast<double>(Count(answers, Outcome::kSensorDropout)), lost * n,
                4.0 * std::sqrt(n * lost * (1.0 - lost)))
        << range_m;
  }
}

// Surfaces of intensity 0.5, and none behind every second firing.
TEST(SensorDropout, LosesDarkSurfacesByTheirIntensityAndNoneWhereThereIsNoSurface) {
  DetectorSpec spec{.effects = {.threshold = true, .sensor_dropout = true}};
  spec.plausibility.dark_dropout_probability = 0.4;
  for (const double scale : {0.1, 0.5, 1.0}) {
    spec.plausibility.dark_dropout_intensity = scale;
    const auto answers =
        Detect(spec, [](std::uint32_t i) { return i % 2 == 0 ? 10.0 : std::nan(""); });
    const double n = kNumFirings / 2.0;
    const double lost = 0.4 * std::exp(-0.5 / scale);
    EXPECT_NEAR(static_cast<double>(Count(answers, Outcome::kSensorDropout)), lost * n,
                4.0 * std::sqrt(n * lost * (1.0 - lost)))
        << scale;
  }
}

// Without effect `threshold` or a physical rung no intensity is computed.
TEST(SensorDropout, LosesNothingForDarknessWhereIntensityIsUnknown) {
  DetectorSpec spec{.effects = {.sensor_dropout = true}};
  spec.plausibility.dark_dropout_probability = 0.4;
  const auto answers = Detect(spec, SpreadOverRange);
  EXPECT_EQ(Count(answers, Outcome::kSensorDropout), 0U);
}

TEST(RangeGate, NoiseBeyondTheGateIsOutOfRange) {
  DetectorSpec spec{.range_max_m = 200.0, .effects = {.noise = true}};
  spec.plausibility.noise_sigma0_m = 0.05;
  spec.plausibility.noise_sigma1 = 0.0;
  spec.plausibility.noise_shape = NoiseShape::kBeam;
  const auto answers = Detect(spec, [](std::uint32_t) { return 199.95; });
  // P(n > 1) = 0.158655 for a standard normal n.
  const double n = kNumFirings;
  EXPECT_NEAR(static_cast<double>(Count(answers, Outcome::kOutOfRange)), 0.158655 * n,
              4.0 * std::sqrt(n * 0.158655 * 0.841345) + 0.0002 * n);
}

}  // namespace
}  // namespace railcast
