#include "core/base/rounded_scale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace railcast {
namespace {

constexpr double kSteps[] = {0.1, 0.3, 1.0, 2.0, 3.0, 4.0, 5.0};  // In standard deviations.
constexpr int kNumSamples = 4000;

/// Draws with a standard deviation of 1 that are rounded, one in fifty of them an outlier.
class Draws {
 public:
  explicit Draws(double step) : step_(step) {}

  double Rounded(double mean) { return step_ * std::round((mean + normal_(random_)) / step_); }
  double Mean() { return mean_(random_); }
  double Outlier(int i) { return i % 50 == 0 ? 30.0 * normal_(random_) : 0.0; }

 private:
  double step_;
  std::mt19937_64 random_{11};
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> mean_{0.0, 100.0};
};

/// Expects the truth, with an interval that is narrow unless the step hides most.
/// @returns Whether the interval holds it.
bool IsOne(const RoundedScale& scale, double per_one, double step) {
  SCOPED_TRACE(step);
  // Five standard errors of the samples, which become more where the step is coarse.
  EXPECT_NEAR(scale.value / per_one, 1.0, 0.06 + 0.01 * step);
  if (step <= 2.0) {
    EXPECT_LT((scale.high - scale.low) / per_one, 0.35);
  }
  return scale.low <= per_one && scale.high >= per_one;
}

// Of 14 intervals, fewer than 12 hold the truth once in 30 times; the draws are always the same.
TEST(RoundedScale, SeesThroughStepsOfBothValuesOfADifference) {
  int holds = 0;
  for (const double step : kSteps) {
    for (const bool is_same_mean : {true, false}) {
      Draws draws(step);
      RoundedSamples samples(step);
      for (int i = 0; i < kNumSamples; ++i) {
        const double a = draws.Mean();
        const double b = is_same_mean ? a : draws.Mean();
        samples.Add(draws.Rounded(b) - b - draws.Rounded(a) + a + draws.Outlier(i));
      }
      holds += IsOne(FindRoundedScale({samples}, RoundedValues::kBoth), std::numbers::sqrt2, step)
                   ? 1
                   : 0;
    }
  }
  EXPECT_GE(holds, 12);
}

TEST(RoundedScale, SeesThroughStepsOfOneValue) {
  int holds = 0;
  for (const double step : kSteps) {
    Draws draws(step);
    RoundedSamples samples(step);
    for (int i = 0; i < kNumSamples; ++i) {
      const double mean = draws.Mean();
      samples.Add(draws.Rounded(mean) - mean + draws.Outlier(i));
    }
    holds += IsOne(FindRoundedScale({samples}, RoundedValues::kOne), 1.0, step) ? 1 : 0;
  }
  EXPECT_GE(holds, 6);
}

TEST(RoundedScale, SaysHowMuchAStepCanHide) {
  // All means are alike, in the middle between two steps.
  for (const double step : {3.0, 5.0, 8.0}) {
    Draws draws(step);
    RoundedSamples samples(step);
    for (int i = 0; i < kNumSamples; ++i) samples.Add(draws.Rounded(0.0) - draws.Rounded(0.0));
    const RoundedScale scale = FindRoundedScale({samples}, RoundedValues::kBoth);
    EXPECT_LT(scale.low, std::numbers::sqrt2) << step;
    EXPECT_GT(scale.high, std::numbers::sqrt2) << step;
  }
}

TEST(RoundedScale, IsAboutTheMean) {
  for (const double shift : {0.25, 1.0, 20.5}) {
    Draws draws(1.0);
    RoundedSamples samples(1.0);
    for (int i = 0; i < kNumSamples; ++i) {
      const double mean = draws.Mean();
      samples.Add(draws.Rounded(mean + shift) - draws.Rounded(mean));
    }
    const double scale = FindRoundedScale({samples}, RoundedValues::kBoth).value;
    EXPECT_NEAR(scale / std::numbers::sqrt2, 1.0, 0.06) << shift;
  }
}

TEST(RoundedScale, IsCommonToSamplesOfSeveralSteps) {
  std::vector<RoundedSamples> samples;
  for (const double step : kSteps) {
    Draws draws(step);
    samples.emplace_back(step);
    for (int i = 0; i < kNumSamples; ++i) {
      const double mean = draws.Mean();
      samples.back().Add(draws.Rounded(mean) - draws.Rounded(mean));
    }
  }
  const RoundedScale scale = FindRoundedScale(samples, RoundedValues::kBoth);
  EXPECT_NEAR(scale.value / std::numbers::sqrt2, 1.0, 0.02);
  EXPECT_LT(scale.high - scale.low, 0.1);
}

TEST(FindStep, FindsTheStepOfDifferencesAndNoneWithoutOne) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> slope;
  for (const double step : kSteps) {
    for (const double spread : {0.5, 5.0}) {
      Draws draws(step);
      std::vector<double> rounded;
      std::vector<double> plain;
      for (int i = 0; i < kNumSamples; ++i) {
        const double mean = draws.Mean();
        rounded.push_back(draws.Rounded(mean + spread * slope(random)) - draws.Rounded(mean));
        plain.push_back(std::hypot(1.0, spread) * slope(random));
      }
      EXPECT_NEAR(FindStep(rounded) / step, 1.0, 1e-3) << spread;
      EXPECT_EQ(FindStep(plain), 0.0) << spread;
    }
  }
  EXPECT_EQ(FindStep({}), 0.0);
  EXPECT_EQ(FindStep(std::vector<double>(100, 0.0)), 0.0);
}

}  // namespace
}  // namespace railcast
