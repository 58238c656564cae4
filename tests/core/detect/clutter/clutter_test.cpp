#include "core/detect/clutter/clutter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "core/detect/base/beam_optics.h"
#include "core/detect/base/weather_optics.h"
#include "tests/core/detect/facing_beams.h"

namespace railcast {
namespace {

// Compares echoes of drops and flakes, and false alarms, with the closed forms of
// docs/physics.md 4.2.

constexpr ClutterLabels kLabels{.rain = 23, .snow = 24, .fog = 25, .false_alarm = 27};

DetectorSpec RainSpec(double clutter_gain) {
  DetectorSpec spec{.seed = 5, .range_min_m = 0.0, .effects = {.clutter = true}};
  spec.beam.divergence_mrad = {3.0, 3.0};
  spec.receiver.clutter_gain = clutter_gain;
  spec.weather.rain_rate_mmph = 50.0;
  spec.clutter_labels = kLabels;
  return spec;
}

ParticleEchoes Expected(const DetectorSpec& spec) {
  return ParticleEchoesOf(RainDropSizes(spec.weather), kDropReflectance, spec.beam, 0.1 / 4e4);
}

// Distribution function of the Maxwell law of scale a.
double MaxwellCdf(double r, double a) {
  return std::erf(r / (a * std::numbers::sqrt2)) -
         std::sqrt(2.0 / std::numbers::pi) * r / a * std::exp(-r * r / (2.0 * a * a));
}

// The Kolmogorov-Smirnov distance: the largest difference between the sample's distribution
// function and `cdf`.
template <typename Cdf>
double KolmogorovSmirnov(std::vector<double> sample, const Cdf& cdf) {
  std::sort(sample.begin(), sample.end());
  const auto n = static_cast<double>(sample.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const double p = cdf(sample[i]);
    worst = std::max({worst, std::abs(p - static_cast<double>(i) / n),
                      std::abs(p - static_cast<double>(i + 1) / n)});
  }
  return worst;
}

std::vector<double> RangesOf(const std::vector<FacingEcho>& echoes) {
  std::vector<double> ranges_m;
  for (const FacingEcho& echo : echoes) {
    ranges_m.push_back(static_cast<double>(echo.range_m));
  }
  return ranges_m;
}

TEST(Clutter, CountsArePoissonInEmptyBeams) {
  const DetectorSpec spec = RainSpec(1.0);
  const FacingBeams beams;
  std::vector<std::size_t> count(beams.num_firings);
  for (const FacingEcho& echo : ClutterOf(DetectFacing(spec, beams))) ++count[echo.firing];
  const double mean = Expected(spec).mean_count;  // 0.93
  const double n = beams.num_firings;
  double p = std::exp(-mean);
  for (std::size_t k = 0; k < 6; ++k) {
    const auto seen = static_cast<double>(std::count(count.begin(), count.end(), k));
    EXPECT_NEAR(seen, n * p, 4.0 * std::sqrt(n * p * (1.0 - p))) << k;
    p *= mean / static_cast<double>(k + 1);
  }
}

TEST(Clutter, GainMultipliesTheMeanCount) {
  for (const double gain : {0.1, 10.0}) {
    const DetectorSpec spec = RainSpec(gain);
    FacingBeams beams;
    beams.num_firings = 1U << 16U;
    const double mean = gain * Expected(spec).mean_count * beams.num_firings;
    EXPECT_NEAR(static_cast<double>(ClutterOf(DetectFacing(spec, beams)).size()), mean,
                4.0 * std::sqrt(mean));
  }
}

TEST(Clutter, RangesFollowMaxwellsLaw) {
  const DetectorSpec spec = RainSpec(1.0);
  const auto ranges_m = RangesOf(ClutterOf(DetectFacing(spec, {})));
  const double a = Expected(spec).range_scale_m;
  const auto n = static_cast<double>(ranges_m.size());
  double sum = 0.0;
  double squares = 0.0;
  for (const double r : ranges_m) {
    sum += r;
    squares += r * r;
  }
  const double variance = a * a * (3.0 - 8.0 / std::numbers::pi);
  EXPECT_NEAR(sum / n, 2.0 * a * std::sqrt(2.0 / std::numbers::pi), 4.0 * std::sqrt(variance / n));
  // E[r^2] = 3 a^2, Var[r^2] = 6 a^4.
  EXPECT_NEAR(squares / n, 3.0 * a * a, 4.0 * a * a * std::sqrt(6.0 / n));
  EXPECT_LE(KolmogorovSmirnov(ranges_m, [&](double r) { return MaxwellCdf(r, a); }),
            1.95 / std::sqrt(n));
}

TEST(Clutter, StandsInFrontOfTheFirstSurfaceOnly) {
  const DetectorSpec spec = RainSpec(1.0);
  FacingBeams beams;
  beams.range_m = [](std::uint32_t) { return 4.0; };
  const auto clutter = ClutterOf(DetectFacing(spec, beams));
  // Nearer to the surface, the receiver does not tell the two apart.
  const double last_m = 4.0 - 2.0 * PulseSigma_m(spec.beam);
  for (const FacingEcho& echo : clutter) ASSERT_LE(static_cast<double>(echo.range_m), last_m);
  const ParticleEchoes expected = Expected(spec);
  const double mean =
      expected.mean_count * beams.num_firings * MaxwellCdf(last_m, expected.range_scale_m);
  EXPECT_NEAR(static_cast<double>(clutter.size()), mean, 4.0 * std::sqrt(mean));
}

// docs/physics.md 4.2: one in 58 drops is stronger than a target of reflectance 0.5 at 30 m.
TEST(Clutter, IsSeldomStrongerThanABrightTarget) {
  const DetectorSpec spec = RainSpec(10.0);
  FacingBeams beams;
  beams.num_firings = 1U << 17U;
  beams.range_m = [](std::uint32_t) { return 30.0; };
  const auto all = DetectFacing(spec, beams);
  const float wall_ratio = all.front().power_ratio;
  const auto clutter = ClutterOf(all);
  const auto stronger =
      static_cast<double>(std::count_if(clutter.begin(), clutter.end(), [&](const FacingEcho& e) {
        return e.power_ratio > wall_ratio;
      }));
  const double expected = 10.0 * Expected(spec).mean_count * beams.num_firings / 57.56;
  EXPECT_NEAR(stronger, expected, 4.0 * std::sqrt(expected));
}

TEST(Clutter, DropsStayWhereTheyAreWhateverElseIsOn) {
  DetectorSpec spec = RainSpec(1.0);
  FacingBeams beams;
  beams.num_firings = 1U << 12U;
  const auto only_rain = ClutterOf(DetectFacing(spec, beams));
  spec.weather.snow_rate_mmph = 2.0;
  spec.weather.visibility_m = 100.0;
  spec.weather.sun.illuminance_klx = 100.0;
  spec.effects = {.surface_response = true, .clutter = true, .fog_echo = true, .sunlight = true};
  std::vector<FacingEcho> rain;
  for (const FacingEcho& echo : ClutterOf(DetectFacing(spec, beams))) {
    if (echo.clutter == kLabels.rain) rain.push_back(echo);
  }
  EXPECT_GT(rain.size(), 3000U);
  EXPECT_EQ(rain, only_rain);
}

// A drop at range r with a diameter of D times the least detectable one has the power ratio
// D^2 e^(-2 alpha r), and P(D > d) = e^(-b r^2 (d - 1)).
TEST(Clutter, IsWeakenedByTheAirBeforeIt) {
  DetectorSpec spec = RainSpec(1.0);
  spec.weather.visibility_m = 50.0;
  spec.effects.extinction = true;
  const FacingBeams beams;
  const auto clutter = ClutterOf(DetectFacing(spec, beams));
  const auto detectable = static_cast<double>(std::ranges::count_if(
      clutter, [](const FacingEcho& echo) { return echo.power_ratio >= 1.0F; }));
  const ParticleEchoes drops = Expected(spec);
  const double alpha_per_m = Extinction_per_m(spec.weather, spec.beam.wavelength_nm);
  constexpr double kStep_m = 1e-3;
  double share = 0.0;
  for (double r = 0.5 * kStep_m; r < 10.0 * drops.range_scale_m; r += kStep_m) {
    const double probability = MaxwellCdf(r + 0.5 * kStep_m, drops.range_scale_m) -
                               MaxwellCdf(r - 0.5 * kStep_m, drops.range_scale_m);
    share += probability *
             std::exp(-drops.least_diameter_per_m2 * r * r * (std::exp(alpha_per_m * r) - 1.0));
  }
  EXPECT_LT(share, 0.9);
  const double mean = share * drops.mean_count * beams.num_firings;
  EXPECT_NEAR(detectable, mean, 4.0 * std::sqrt(mean));
  // Intensities are those before attenuation, of a reflectance at that range.
  for (const FacingEcho& echo : clutter) {
    const double r = static_cast<double>(echo.true_range_m);
    const double clear = static_cast<double>(echo.power_ratio) * std::exp(2.0 * alpha_per_m * r);
    ASSERT_NEAR(static_cast<double>(echo.intensity) / (clear * 0.1 / 4e4 * r * r), 1.0, 1e-4);
  }
}

// Two echoes with the same number would share their random draws.
TEST(Clutter, GivesEveryDropAndFlakeOfAFiringItsOwnNumber) {
  DetectorSpec spec = RainSpec(1.0);
  spec.weather.snow_rate_mmph = 2.0;
  FacingBeams beams;
  beams.num_firings = 1U << 12U;
  std::set<std::pair<std::uint32_t, std::uint32_t>> numbers;
  const auto clutter = ClutterOf(DetectFacing(spec, beams));
  for (const FacingEcho& echo : clutter) numbers.insert({echo.firing, echo.echo});
  EXPECT_EQ(numbers.size(), clutter.size());
  EXPECT_GT(clutter.size(), 10'000U);
}

TEST(Clutter, ComesFromNothingWithoutWeather) {
  DetectorSpec spec = RainSpec(1.0);
  spec.weather.rain_rate_mmph = 0.0;
  EXPECT_TRUE(ClutterOf(DetectFacing(spec, {})).empty());
}

TEST(FalseAlarms, ComeAtTheStatedRateAnywhereWithinTheGate) {
  DetectorSpec spec{.range_min_m = 10.0, .range_max_m = 210.0, .effects = {.sunlight = true}};
  spec.weather.sun.illuminance_klx = 100.0;
  spec.clutter_labels = kLabels;
  FacingBeams beams;
  beams.num_firings = 1U << 22U;
  const auto alarms = ClutterOf(DetectFacing(spec, beams));
  const double expected = 1e-4 * beams.num_firings;  // 419
  EXPECT_NEAR(static_cast<double>(alarms.size()), expected, 4.0 * std::sqrt(expected));
  EXPECT_LE(KolmogorovSmirnov(RangesOf(alarms), [](double r) { return (r - 10.0) / 200.0; }),
            1.95 / std::sqrt(expected));
  for (const FacingEcho& alarm : alarms) {
    EXPECT_EQ(alarm.outcome, Outcome::kClutter);
    EXPECT_EQ(alarm.power_ratio, 1.0F);
  }
}

DetectorSpec WithForeignPulses(double rate_hz) {
  DetectorSpec spec{.effects = {.detection = true, .interference = true}};
  spec.receiver.foreign_pulses_hz = rate_hz;
  spec.clutter_labels.false_alarm = 27;
  return spec;
}

// 299.5 m are 1.998 us: at 5000 pulses per second 1 - exp(-0.00999) of the firings.
TEST(Interference, ReachesTheShareOfFiringsThatListenWhenAPulseArrives) {
  const FacingBeams beams;
  const std::vector<FacingEcho> echoes = ClutterOf(DetectFacing(WithForeignPulses(5000.0), beams));
  const double n = beams.num_firings;
  const double p = -std::expm1(-5000.0 * 2.0 * 299.5 / 299'792'458.0);
  EXPECT_NEAR(p, 0.00994, 1e-5);
  EXPECT_NEAR(static_cast<double>(echoes.size()), n * p, 4.0 * std::sqrt(n * p));
  for (const FacingEcho& echo : echoes) {
    EXPECT_EQ(echo.outcome, Outcome::kClutter);
    EXPECT_EQ(echo.clutter, 27U);
  }
}

// The largest distance between the empirical distribution of values in [0, 1) and the uniform one.
double DistanceFromUniform(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double most = 0.0;
  const auto n = static_cast<double>(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto rank = static_cast<double>(i);
    most = std::max({most, std::abs(values[i] - rank / n), std::abs(values[i] - (rank + 1.0) / n)});
  }
  return most;
}

TEST(Interference, SpreadsEvenlyOverTheGateWithPowersThatFallAsTheInverse) {
  std::vector<double> places;
  std::vector<double> powers;
  for (const FacingEcho& echo : ClutterOf(DetectFacing(WithForeignPulses(50'000.0), {}))) {
    places.push_back((static_cast<double>(echo.range_m) - 0.5) / 299.5);
    powers.push_back(1.0 - 1.0 / static_cast<double>(echo.power_ratio));
  }
  // Kolmogorov and Smirnov's limit at one in a thousand.
  const double limit = 1.95 / std::sqrt(static_cast<double>(places.size()));
  EXPECT_LT(DistanceFromUniform(places), limit);
  EXPECT_LT(DistanceFromUniform(powers), limit);
}

// One pulse in five is stronger than 5 times the threshold.
TEST(Interference, IsClippedWhereTheReceiverSaturates) {
  DetectorSpec spec = WithForeignPulses(50'000.0);
  const std::vector<FacingEcho> bare = ClutterOf(DetectFacing(spec, {}));
  spec.effects.saturation = true;
  spec.receiver.saturation_power_ratio = 5.0;
  const std::vector<FacingEcho> clipped = ClutterOf(DetectFacing(spec, {}));
  ASSERT_EQ(clipped.size(), bare.size());
  std::size_t num_clipped = 0;
  for (std::size_t i = 0; i < bare.size(); ++i) {
    EXPECT_EQ(clipped[i].power_ratio, std::min(bare[i].power_ratio, 5.0F));
    EXPECT_EQ(clipped[i].range_m, bare[i].range_m);
    num_clipped += bare[i].power_ratio > 5.0F ? 1 : 0;
  }
  const auto n = static_cast<double>(bare.size());
  EXPECT_NEAR(static_cast<double>(num_clipped), 0.2 * n, 4.0 * std::sqrt(0.16 * n));
}

}  // namespace
}  // namespace railcast
