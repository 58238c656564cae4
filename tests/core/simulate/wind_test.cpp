#include "core/simulate/wind.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/random.h"

namespace railcast {
namespace {

const Vector3 kVelocity_mps(8.0, 6.0, 0.0);
constexpr double kSpeed_mps = 10.0;
constexpr int kNumSeeds = 10'000;
constexpr double kNumSigmas = 5.0;

TEST(Wind, GustsHaveMeanZeroAndVarianceOne) {
  double sum = 0.0;
  double sum_of_squares = 0.0;
  for (std::uint64_t seed = 0; seed < kNumSeeds; ++seed) {
    const double gust = Wind(kVelocity_mps, seed).Gust({500.0, -300.0, 2.0}, 47.0);
    sum += gust;
    sum_of_squares += gust * gust;
  }
  EXPECT_NEAR(sum / kNumSeeds, 0.0, kNumSigmas / std::sqrt(kNumSeeds));
  // A sum of cosines has a smaller fourth moment than the normal distribution, whose mean square
  // has the variance 2 / n.
  EXPECT_NEAR(sum_of_squares / kNumSeeds, 1.0, kNumSigmas * std::sqrt(2.0 / kNumSeeds));
}

// The autocovariance is the cosine transform of the spectrum below f = U / L.
TEST(Wind, GustsHaveKaimalsSpectrum) {
  for (const double lag_s : {1.0, 5.0, 20.0}) {
    constexpr int kNumSteps = 20'000;
    double expected = 0.0;
    double total = 0.0;
    for (int i = 0; i < kNumSteps; ++i) {
      const double x = (i + 0.5) / kNumSteps;
      const double density = 6.8 / std::pow(1.0 + 10.2 * x, 5.0 / 3.0);
      total += density;
      expected += density * std::cos(2.0 * std::numbers::pi * x * kSpeed_mps / 63.1 * lag_s);
    }
    expected /= total;
    EXPECT_NEAR(total / kNumSteps, Wind::kSlowShare, 1e-3);
    double sum = 0.0;
    for (std::uint64_t seed = 0; seed < kNumSeeds; ++seed) {
      const Wind wind(kVelocity_mps, seed);
      sum += wind.Gust(Vector3::Zero(), 0.0) * wind.Gust(Vector3::Zero(), lag_s);
    }
    // The product of two standard normal numbers has at most the variance 2.
    EXPECT_NEAR(sum / kNumSeeds, expected, kNumSigmas * std::sqrt(2.0 / kNumSeeds)) << lag_s;
  }
}

TEST(Wind, CarriesItsGustsAlong) {
  const Wind wind(kVelocity_mps, 3);
  double greatest = 0.0;
  for (int i = 0; i < 50; ++i) {
    const Vector3 place_m(17.0 * i, 400'000.0 - 3.0 * i, 0.0);
    const double now = wind.Gust(place_m, 10.0);
    EXPECT_NEAR(wind.Gust(place_m + 6.0 * kVelocity_mps, 16.0), now, 1e-6);
    greatest = std::max(greatest, std::abs(wind.Gust(place_m, 16.0) - now));
  }
  EXPECT_GT(greatest, 0.5);
}

// R^2 by EN 1991-1-4 annex B, computed apart from this program: 0.5 Hz, zeta = 0.1, b = 0, and
// 0.945 Hz, zeta = 0.027, b = 65 m.
TEST(Wind, ResonanceIsThatOfTheStandard) {
  const Wind wind(kVelocity_mps, 1);
  EXPECT_NEAR(wind.Resonance(0.5, 0.1, 0.0), 0.4918, 1e-4);
  EXPECT_NEAR(wind.Resonance(0.945, 0.027, 65.0), 0.04242, 1e-5);
  EXPECT_NEAR(Wind::kTurbulence, 1.0 / std::log(10.0 / 0.05), 1e-4);
  EXPECT_NEAR(Wind::kLength_m, 300.0 * std::pow(0.05, 0.67 + 0.05 * std::log(0.05)), 0.1);
}

TEST(Ringing, HasItsFrequencyAndVarianceOne) {
  const auto words = RandomWords(1, RandomUse::kTreeSway, 2, 3);
  constexpr double kStep_s = 0.02;
  constexpr int kNumSteps = 500'000;  // 1e4 s: several thousand periods.
  double sum_of_squares = 0.0;
  int num_rises = 0;
  double before = Ringing(words, 0.5, 0.1, 0.0);
  for (int i = 1; i <= kNumSteps; ++i) {
    const double now = Ringing(words, 0.5, 0.1, kStep_s * i);
    sum_of_squares += now * now;
    num_rises += before < 0.0 && now >= 0.0 ? 1 : 0;
    before = now;
  }
  // Mixed terms beat at 0.087 Hz or faster: over 1e4 s their mean is below 1 / (2 pi 870) each.
  EXPECT_NEAR(sum_of_squares / kNumSteps, 1.0, 2e-3);
  // Rate of rises of three equal sinusoids: between the lowest and the highest frequency, and close
  // to sqrt(mean f^2) = 0.5 sqrt(1 + 2 zeta^2), as for noise of that spectrum (Rice 1944).
  EXPECT_NEAR(num_rises / (kStep_s * kNumSteps), 0.505, 0.02);
}

}  // namespace
}  // namespace railcast
