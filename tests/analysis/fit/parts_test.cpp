// The parts of a fit against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "analysis/fit/detection.h"
#include "analysis/fit/noise.h"
#include "analysis/fit/random_loss.h"
#include "analysis/fit/reflectance.h"
#include "analysis/fit/trial_sample.h"

namespace railcast {
namespace {

std::vector<StrongTrial> StrongTrials(double probability, double rate_per_m, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<StrongTrial> trials;
  for (int i = 0; i < 20'000; ++i) {
    const double range_m = 200.0 * unit(random);
    const double back = (1.0 - probability) * std::exp(-rate_per_m * range_m);
    trials.push_back({range_m, unit(random) < back});
  }
  return trials;
}

TEST(RandomLoss, TellsDropoutFromRainByTheRange) {
  int holds = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const RandomLossFit fit = FitRandomLoss(StrongTrials(0.08, 0.002, seed), true);
    EXPECT_NEAR(fit.probability.value, 0.08, 0.03);
    holds += fit.probability.low <= 0.08 && 0.08 <= fit.probability.high ? 1 : 0;
    holds += fit.rate_per_m.low <= 0.002 && 0.002 <= fit.rate_per_m.high ? 1 : 0;
  }
  // Of 40 that hold 95 times in 100 fewer than 35 do once in 300 times.
  EXPECT_GE(holds, 35);
}

TEST(RandomLoss, IsZeroWhereItWouldBeLess) {
  int holds = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const RandomLossFit only_rain = FitRandomLoss(StrongTrials(0.0, 0.002, seed), true);
    EXPECT_GE(only_rain.probability.value, 0.0);
    holds += only_rain.probability.low == 0.0 ? 1 : 0;
    EXPECT_NEAR(only_rain.rate_per_m.value, 0.002, 0.0003);
    const RandomLossFit only_dropout = FitRandomLoss(StrongTrials(0.1, 0.0, seed), true);
    EXPECT_GE(only_dropout.rate_per_m.value, 0.0);
    holds += only_dropout.rate_per_m.low == 0.0 ? 1 : 0;
  }
  EXPECT_GE(holds, 35);
}

TEST(RandomLoss, IsBoundedWhereNothingIsLost) {
  const RandomLossFit fit = FitRandomLoss(StrongTrials(0.0, 0.0, 1), true);
  EXPECT_EQ(fit.probability.value, 0.0);
  EXPECT_EQ(fit.probability.low, 0.0);
  // Three in 20,000 would have been seen.
  EXPECT_LT(fit.probability.high, 3e-4);
  EXPECT_EQ(fit.rate_per_m.value, 0.0);
}

TEST(RandomLoss, GivesNothingFromFewTrials) {
  const RandomLossFit fit = FitRandomLoss({{10.0, true}, {20.0, false}}, true);
  EXPECT_FALSE(fit.probability.is_enough());
  EXPECT_EQ(fit.loss().Survival(100.0), 1.0);
}

TEST(FitReflectance, StandsAThirdOfWildIntensities) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::vector<IntensitySample> samples;
  for (int i = 0; i < 3000; ++i) {
    const double cosine = 0.2 + 0.8 * (i % 100) / 100.0;
    double intensity = 0.4 * cosine + 0.05 + 0.02 * normal(random);
    if (i % 3 == 0) intensity = 0.6 + 0.3 * normal(random);
    samples.push_back({cosine, 0.05, intensity});
  }
  const Estimate estimate = FitReflectance(samples);
  EXPECT_NEAR(estimate.value, 0.4, 0.01);
}

TEST(FitReflectance, StatesAnIntervalThatHolds) {
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  int holds = 0;
  for (int run = 0; run < 100; ++run) {
    std::vector<IntensitySample> samples;
    for (int i = 0; i < 200; ++i) {
      const double cosine = 0.2 + 0.8 * i / 200.0;
      samples.push_back({cosine, 0.0, 0.4 * cosine + 0.05 * normal(random)});
    }
    const Estimate estimate = FitReflectance(samples);
    holds += estimate.low <= 0.4 && 0.4 <= estimate.high ? 1 : 0;
  }
  // 95 less four standard deviations.
  EXPECT_GE(holds, 87);
}

// Uniform powers, all lost below the step, a share lost above: the step lies between the trials.
TEST(HardThreshold, StatesAnIntervalThatHolds) {
  int holds = 0;
  double half_widths = 0.0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    DetectionProblem problem;
    problem.extinction_per_m = 0.0;
    problem.loss.probability = 0.3;
    for (int i = 0; i < 2000; ++i) {
      const double log_gain = 2.0 * unit(random) - 1.0;
      const bool is_strong = 0.25 + log_gain >= 0.0;
      problem.trials.push_back({std::exp(log_gain), 0.0, 50.0, 0, is_strong && unit(random) > 0.3});
    }
    const DetectionFit fit = FitHardThreshold(problem, LookAtGroups(problem));
    const double half = 1.96 * std::sqrt(fit.covariance(0, 0));
    holds += std::abs(fit.theta[0] - 0.25) <= half ? 1 : 0;
    half_widths += half;
  }
  EXPECT_GE(holds, 87);
  // Trials lie 1e-3 apart.
  EXPECT_LT(half_widths / 100.0, 5e-3);
}

TEST(Noise, SigmaOfALineHasAnIntervalThatHolds) {
  int holds = 0;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::vector<Trial> trials(20'000);
    std::vector<double> range_m, nothing(trials.size(), std::nan(""));
    for (std::size_t i = 0; i < trials.size(); ++i) {
      const double at_m = 1.0 + 199.0 * static_cast<double>(i) / 20'000.0;
      trials[i].answer = Answer::kReturned;
      trials[i].expected_m = static_cast<float>(at_m);
      trials[i].residual_m = static_cast<float>((0.02 + 1e-4 * at_m) * normal(random));
      range_m.push_back(at_m);
    }
    const LinearNoise noise = FitLinearNoise(BinNoise(trials, range_m, nothing));
    EXPECT_NEAR(noise.sigma0_m.value, 0.02, 0.002);
    holds += noise.sigma0_m.low <= 0.02 && 0.02 <= noise.sigma0_m.high ? 1 : 0;
    holds += noise.sigma1.low <= 1e-4 && 1e-4 <= noise.sigma1.high ? 1 : 0;
  }
  // Of 100, 95 less four standard deviations.
  EXPECT_GE(holds, 87);
}

TEST(Noise, TakesTheBiasOfEachChannelOut) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<Trial> trials(32'000);
  std::vector<double> biases_m;
  for (int channel = 0; channel < 32; ++channel) biases_m.push_back(0.02 * normal(random));
  for (std::size_t i = 0; i < trials.size(); ++i) {
    trials[i].answer = Answer::kReturned;
    trials[i].channel = static_cast<std::uint16_t>(i % 32);
    trials[i].residual_m = static_cast<float>(biases_m[i % 32] + 0.01 * normal(random));
  }
  const Residuals residuals = TakeOutChannels(trials);
  ASSERT_EQ(residuals.channels.size(), 32U);
  for (std::size_t channel = 0; channel < 32; ++channel) {
    // Median of 1000: four standard errors.
    EXPECT_NEAR(residuals.channels[channel].bias_m.value, biases_m[channel],
                4.0 * 1.2533 * 0.01 / std::sqrt(1000.0));
  }
  EXPECT_LE(residuals.bias_sigma_m.low, 0.02);
  EXPECT_GE(residuals.bias_sigma_m.high, 0.02);
}

Trial TrialAt(float range_m, float cosine, std::uint16_t surface) {
  Trial trial;
  trial.expected_m = range_m;
  trial.cos_incidence = cosine;
  trial.surface = surface;
  return trial;
}

TEST(TrialSample, DoesNotDependOnTheOrder) {
  constexpr std::uint64_t kNumTrials = 2 * TrialSample::kMaxTrials;
  std::vector<std::pair<Trial, std::uint64_t>> all;
  for (std::uint64_t i = 0; i < kNumTrials; ++i) {
    // Cells of very different sizes.
    const auto cell = static_cast<float>(i % 7 == 0 ? i % 29 : 1);
    all.emplace_back(TrialAt(1.0F + cell * 9.0F, 0.5F, static_cast<std::uint16_t>(i % 3)), i);
    all.back().first.residual_m = static_cast<float>(i);
  }
  TrialSample forwards, backwards;
  for (const auto& [trial, id] : all) forwards.Add(trial, id);
  std::reverse(all.begin(), all.end());
  for (const auto& [trial, id] : all) backwards.Add(trial, id);
  const std::vector<Trial> a = forwards.trials();
  const std::vector<Trial> b = backwards.trials();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_EQ(a[i].residual_m, b[i].residual_m);
  EXPECT_LE(a.size(), TrialSample::kMaxTrials);
  EXPECT_GT(a.size(), TrialSample::kMaxTrials / 4);
  EXPECT_EQ(forwards.num_seen(), kNumTrials);
}

TEST(TrialSample, StandsAnyRangeAndIncidence) {
  TrialSample sample;
  std::uint64_t id = 0;
  for (const float range_m : {1e-3F, 0.5F, 300.0F, 1e6F}) {
    for (const float cosine : {1e-6F, 0.5F, 1.0F}) sample.Add(TrialAt(range_m, cosine, 0), ++id);
  }
  EXPECT_EQ(sample.trials().size(), 12U);
}

}  // namespace
}  // namespace railcast
