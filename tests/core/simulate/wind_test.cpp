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

const Vector3 kDownwind(0.6, -0.8, 0.0);
const Vector3 kAside(0.8, 0.6, 0.0);
constexpr double kTreeWind_mps = 12.0;
constexpr double kTreeSigmas = 5.0;

// Moore and Maguire 2004: 10 m and 22 cm.
TEST(TreeSway, NaturalFrequencyFallsWithHeight) {
  EXPECT_NEAR(TreeFrequency_hz(10.0), 0.0766 + 3.1219 * 22.0 / 100.0, 1e-12);
  EXPECT_NEAR(TreeFrequency_hz(14.0), 0.0766 + 3.1219 * 30.8 / 196.0, 1e-12);
}

TEST(TreeSway, MeanAndRootMeanSquareAreThoseStated) {
  constexpr int kNumTrees = 20'000;
  constexpr double kHeight_m = 10.0;
  const double mean_m = 0.015 * kHeight_m * std::pow(1.2, 4.0 / 3.0);
  double along_m = 0.0;
  double along2_m2 = 0.0;
  double across_m = 0.0;
  double across2_m2 = 0.0;
  for (std::uint32_t i = 0; i < kNumTrees; ++i) {
    const Wind wind(kTreeWind_mps * kDownwind, i);
    const Vector3 tip_m = TreeTip_m(wind, {{3.0 * i, 5.0, 1.0}, kHeight_m, i / 100, i % 100}, 33.0);
    EXPECT_EQ(tip_m.z(), 0.0);
    const double along = tip_m.dot(kDownwind) - mean_m;
    const double across = tip_m.dot(kAside);
    along_m += along;
    along2_m2 += along * along;
    across_m += across;
    across2_m2 += across * across;
  }
  // R^2 at 0.763 Hz, zeta = 0.1, 12 m/s, by EN 1991-1-4 annex B.
  const double x = 0.7634 * 63.1 / 12.0;
  const double resonance = M_PI / 0.4 * 6.8 * x / std::pow(1.0 + 10.2 * x, 5.0 / 3.0);
  const double sigma_along_m = mean_m * 4.0 / 3.0 * 0.1887 * std::sqrt(0.8 + resonance);
  const double sigma_across_m = mean_m * 0.8 * 0.1887 * std::sqrt(0.8 + resonance);
  const double mean_tolerance = kTreeSigmas / std::sqrt(kNumTrees);
  const double square_tolerance = kTreeSigmas * std::sqrt(2.0 / kNumTrees);
  EXPECT_NEAR(along_m / kNumTrees, 0.0, mean_tolerance * sigma_along_m);
  EXPECT_NEAR(across_m / kNumTrees, 0.0, mean_tolerance * sigma_across_m);
  EXPECT_NEAR(along2_m2 / kNumTrees / std::pow(sigma_along_m, 2), 1.0, square_tolerance);
  EXPECT_NEAR(across2_m2 / kNumTrees / std::pow(sigma_across_m, 2), 1.0, square_tolerance);
  // Some centimetres, as a tree of this size in leaf sways in such a wind.
  EXPECT_GT(sigma_along_m, 0.03);
  EXPECT_LT(sigma_along_m, 0.10);
}

TEST(TreeSway, NeighboursFeelTheSameGustsAndRingByThemselves) {
  const Wind wind(kTreeWind_mps * kDownwind, 1);
  double same = 0.0;
  double other = 0.0;
  constexpr int kNumTimes = 4000;
  for (int i = 0; i < kNumTimes; ++i) {
    const double time_s = 0.7 * i;
    const Vector3 a_m = TreeTip_m(wind, {{0, 0, 0}, 10.0, 1, 1}, time_s);
    const Vector3 b_m = TreeTip_m(wind, {{2, 0, 0}, 10.0, 1, 2}, time_s);
    const double mean_m = MeanTreeTip_m(kTreeWind_mps, 10.0);
    same += (a_m.dot(kDownwind) - mean_m) * (b_m.dot(kDownwind) - mean_m);
    other += a_m.dot(kAside) * b_m.dot(kAside);
  }
  const double scale_m2 = std::pow(MeanTreeTip_m(kTreeWind_mps, 10.0) * Wind::kTurbulence, 2);
  // Gusts have 0.8 of (4/3)^2; the two trees' own sway is independent.
  EXPECT_GT(same / kNumTimes / scale_m2, 0.7);
  EXPECT_NEAR(other / kNumTimes / scale_m2, 0.0, 0.3);
}

/// 65 m to the north, of the default contact line.
WireSpan NorthwardSpan() {
  return {.number = 4,
          .begin_m = {100.0, 200.0, 5.5},
          .end_m = {100.0, 265.0, 5.5},
          .tension_n = 20e3,
          .mass_kg_per_m = 1.3256,
          .width_m = 0.021};
}

// q = 1.25 / 2 x 0.021 m x (10 m/s)^2 = 1.3125 N/m; q L^2 / 8 T = 34.66 mm.
TEST(SpanSway, MeanBlowOffIsThatOfContactLineDesign) {
  const Wind eastward({10.0, 0.0, 0.0}, 1);
  EXPECT_NEAR(MeanSpanBlowOff_m(eastward, NorthwardSpan()), -1.3125 * 65.0 * 65.0 / 160e3, 1e-12);
  EXPECT_NEAR(MeanSpanBlowOff_m(Wind({-20.0, 0.0, 0.0}, 1), NorthwardSpan()), 4.0 * 0.034658, 1e-6);
  // Only what blows across it counts: at 30 degrees, a quarter.
  EXPECT_NEAR(MeanSpanBlowOff_m(Wind({5.0, std::sqrt(75.0), 0.0}, 1), NorthwardSpan()),
              -0.034658 / 4.0, 1e-6);
  EXPECT_NEAR(MeanSpanBlowOff_m(Wind({0.0, 10.0, 0.0}, 1), NorthwardSpan()), 0.0, 1e-12);
}

TEST(SpanSway, IsAParabolaThatIsZeroAtTheSupports) {
  const WireSpan span = NorthwardSpan();
  EXPECT_EQ(BlowOffShare(span, span.begin_m), 0.0);
  EXPECT_EQ(BlowOffShare(span, span.end_m), 0.0);
  EXPECT_EQ(BlowOffShare(span, {100.0, 232.5, 7.0}), 1.0);
  for (const double x_m : {5.0, 20.0, 48.0}) {
    const double share = 4.0 * x_m * (65.0 - x_m) / (65.0 * 65.0);
    EXPECT_NEAR(BlowOffShare(span, {100.0, 200.0 + x_m, 6.1}), share, 1e-12);
  }
  EXPECT_TRUE(LeftOf(span).isApprox(-Vector3::UnitX()));
}

TEST(SpanSway, RingsAsAStringThatTheAirDamps) {
  const Wind wind({10.0, 0.0, 0.0}, 1);
  const SpanGusts gusts = SpanGustsOf(wind, NorthwardSpan());
  EXPECT_NEAR(gusts.frequency_hz, std::sqrt(20e3 / 1.3256) / 130.0, 1e-12);
  const double drag = 1.25 * 0.021 * 10.0 / (2.0 * 1.3256 * 2.0 * M_PI * gusts.frequency_hz);
  EXPECT_NEAR(gusts.damping, 0.01 + drag, 1e-12);
}

TEST(SpanSway, RootMeanSquareIsThatStated) {
  constexpr int kNumSeeds = 20'000;
  const WireSpan span = NorthwardSpan();
  const Wind any({10.0, 0.0, 0.0}, 1);
  const double mean_m = MeanSpanBlowOff_m(any, span);
  double sum_m = 0.0;
  double sum2_m2 = 0.0;
  for (std::uint64_t seed = 0; seed < kNumSeeds; ++seed) {
    const double sway_m = SpanBlowOff_m(Wind({10.0, 0.0, 0.0}, seed), span, 81.0) - mean_m;
    sum_m += sway_m;
    sum2_m2 += sway_m * sway_m;
  }
  const double background = 0.8 / (1.0 + 0.9 * std::pow(65.0 / 63.1, 0.63));
  const double resonance =
      any.Resonance(SpanGustsOf(any, span).frequency_hz, SpanGustsOf(any, span).damping, 65.0);
  const double sigma_m = std::abs(mean_m) * 2.0 * 0.1887 * std::sqrt(background + resonance);
  EXPECT_NEAR(sum_m / kNumSeeds, 0.0, 5.0 * sigma_m / std::sqrt(kNumSeeds));
  EXPECT_NEAR(sum2_m2 / kNumSeeds / (sigma_m * sigma_m), 1.0, 5.0 * std::sqrt(2.0 / kNumSeeds));
}

TEST(SpanSway, ASpanWithoutTensionHangsStill) {
  EXPECT_EQ(SpanBlowOff_m(Wind({10.0, 0.0, 0.0}, 1), WireSpan{}, 3.0), 0.0);
}

}  // namespace

}  // namespace railcast
