// Tests the parts of a fit against samples of known distributions.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "analysis/extras/fit/fit.h"
#include "analysis/extras/fit/recorded_trials.h"

namespace railcast {
namespace {

// 20,000 firings at ranges between 0 and 200 m.
std::map<int, LossBin> MakeLosses(double probability, double rate_per_m, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::map<int, LossBin> bins;
  for (int i = 0; i < 20'000; ++i) {
    const double range_m = 200.0 * unit(random);
    const double back = (1.0 - probability) * std::exp(-rate_per_m * range_m);
    LossBin& bin = bins[static_cast<int>(range_m)];
    ++bin.num;
    bin.num_lost += unit(random) < back ? 0 : 1;
    bin.range_sum_m += range_m;
  }
  return bins;
}

bool Covers(const Estimate& estimate, double truth) {
  return estimate.low <= truth && truth <= estimate.high;
}

TEST(RandomLoss, TellsDropoutFromGrowthWithRange) {
  int holds = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const RandomLoss fit = FitRandomLoss(MakeLosses(0.08, 0.002, seed));
    EXPECT_NEAR(fit.probability.value, 0.08, 0.03);
    holds += Covers(fit.probability, 0.08) ? 1 : 0;
    holds += Covers(fit.rate_per_m, 0.002) ? 1 : 0;
  }
  // Of 40 intervals with a coverage of 95 %, fewer than 35 hold the truth once in 300 times.
  EXPECT_GE(holds, 35);
}

TEST(RandomLoss, IsZeroWhereItWouldBeLess) {
  int holds = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const RandomLoss only_growth = FitRandomLoss(MakeLosses(0.0, 0.002, seed));
    EXPECT_GE(only_growth.probability.value, 0.0);
    holds += only_growth.probability.low == 0.0 ? 1 : 0;
    EXPECT_NEAR(only_growth.rate_per_m.value, 0.002, 0.0003);
    const RandomLoss only_dropout = FitRandomLoss(MakeLosses(0.1, 0.0, seed));
    EXPECT_GE(only_dropout.rate_per_m.value, 0.0);
    holds += only_dropout.rate_per_m.low == 0.0 ? 1 : 0;
  }
  EXPECT_GE(holds, 35);
}

TEST(RandomLoss, IsBoundedWhereNothingIsLost) {
  const RandomLoss fit = FitRandomLoss(MakeLosses(0.0, 0.0, 1));
  EXPECT_EQ(fit.probability.value, 0.0);
  EXPECT_EQ(fit.probability.low, 0.0);
  // Three losses in 20,000 firings would have been seen.
  EXPECT_LT(fit.probability.high, 3e-4);
  EXPECT_EQ(fit.rate_per_m.value, 0.0);
}

TEST(RandomLoss, IsNotEnoughOfFewFiringsAndOfNoneThatCameBack) {
  EXPECT_FALSE(FitRandomLoss({{5, {9, 1, 45.0}}}).probability.is_enough());
  EXPECT_FALSE(FitRandomLoss({{5, {99, 99, 495.0}}}).rate_per_m.is_enough());
}

// Pieces of 25 points between 1 and 200 m, with sigma = 0.02 m + 1e-4 R or with a noise that
// depends on slant and signal.
std::vector<NoiseTrial> MakeNoise(int num_pieces, unsigned seed, bool is_signal) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::normal_distribution<double> normal;
  std::vector<NoiseTrial> trials;
  for (int piece = 0; piece < num_pieces; ++piece) {
    const double range_m = 1.0 + 199.0 * unit(random);
    const double slant_m = range_m * unit(random);
    const double intensity = 0.1 + 0.9 * unit(random);
    double sigma_m = 0.02 + 1e-4 * range_m;
    if (is_signal) {
      const double grown_m = 0.1 * 0.01 * range_m / std::sqrt(intensity);
      sigma_m = std::hypot(0.01, grown_m, 2e-4 * slant_m);
    }
    for (int i = 0; i < 25; ++i) {
      trials.push_back({.range_m = static_cast<float>(range_m),
                        .slant_m_per_rad = static_cast<float>(slant_m),
                        .residual_m = static_cast<float>(sigma_m * normal(random)),
                        .intensity = static_cast<float>(intensity),
                        .piece = static_cast<std::uint32_t>(piece),
                        .channel = static_cast<std::uint16_t>(i / 5)});
    }
  }
  return trials;
}

TEST(Noise, OfALineHasIntervalsThatHold) {
  int holds = 0;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const LinearNoise noise = FitLinearNoise(MakeNoise(200, seed, false));
    EXPECT_NEAR(noise.sigma0_m.value, 0.02, 0.003);
    holds += Covers(noise.sigma0_m, 0.02) ? 1 : 0;
    holds += Covers(noise.sigma1, 1e-4) ? 1 : 0;
  }
  // Of 100 intervals, 95 minus four standard deviations.
  EXPECT_GE(holds, 87);
}

TEST(Noise, OfFloorSignalAndPointingHasIntervalsThatHold) {
  int holds = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const std::vector<NoiseTrial> trials = MakeNoise(400, seed, true);
    std::vector<double> inverse_snr;
    for (const NoiseTrial& trial : trials) {
      const auto range_m = static_cast<double>(trial.range_m);
      inverse_snr.push_back(1e-4 * range_m * range_m / static_cast<double>(trial.intensity));
    }
    const SignalNoise noise = FitSignalNoise(trials, inverse_snr);
    holds += Covers(noise.floor_m, 0.01) ? 1 : 0;
    holds += Covers(noise.scale_m, 0.1) ? 1 : 0;
    holds += Covers(noise.pointing_rad, 2e-4) ? 1 : 0;
  }
  // Of 120 intervals, 95 % minus four standard deviations.
  EXPECT_GE(holds, 105);
}

TEST(Noise, StandsOneWildPointInTwenty) {
  std::vector<NoiseTrial> trials = MakeNoise(400, 1, false);
  std::mt19937_64 random(2);
  for (NoiseTrial& trial : trials) {
    if (random() % 20 == 0)
      trial.residual_m = static_cast<float>(random() % 40'000) * 1e-3F - 20.0F;
  }
  const LinearNoise noise = FitLinearNoise(trials);
  EXPECT_NEAR(noise.sigma0_m.value, 0.02, 0.002);
  EXPECT_NEAR(noise.sigma1.value, 1e-4, 2e-5);
}

// If all points of a piece share their error, the information is in the number of pieces, not of
// points.
TEST(Noise, CountsPiecesNotPointsWherePointsOfAPieceShareTheirScale) {
  std::vector<NoiseTrial> independent = MakeNoise(400, 3, false);
  std::vector<NoiseTrial> shared = independent;
  for (std::size_t i = 0; i < shared.size(); ++i) {
    shared[i].residual_m = shared[i / 25 * 25].residual_m;
  }
  const Estimate few = FitLinearNoise(shared).sigma0_m;
  const Estimate many = FitLinearNoise(independent).sigma0_m;
  // Five times, within the uncertainty of 400 samples of |residual|.
  EXPECT_NEAR((few.high - few.low) / (many.high - many.low), 5.0, 1.0);
}

TEST(Noise, IsNotEnoughOfFewPieces) {
  EXPECT_FALSE(FitLinearNoise({}).sigma0_m.is_enough());
  EXPECT_FALSE(FitLinearNoise(MakeNoise(9, 1, false)).sigma0_m.is_enough());
  EXPECT_FALSE(FitSignalNoise(MakeNoise(9, 1, true), {}).floor_m.is_enough());
}

/// Residuals about pieces or from turn to turn, of ranges that were rounded.
RecordedTrials RoundedTrials(double sigma_m, double step_m, bool is_from_turn_to_turn) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> range(1.0, 100.0);
  std::normal_distribution<double> normal(0.0, sigma_m);
  const auto error_m = [&](double range_m) {
    return step_m * std::round((range_m + normal(random)) / step_m) - range_m;
  };
  RecordedTrials trials;
  trials.step_m = step_m;
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    const double range_m = range(random);
    const double residual_m = error_m(range_m);
    NoiseTrial& trial = trials.noise.emplace_back();
    trial = {.range_m = static_cast<float>(range_m),
             .residual_m = static_cast<float>(2.0 * residual_m),
             .piece = i / 25};
    if (!is_from_turn_to_turn) trial.residual_m = static_cast<float>(residual_m);
    if (!is_from_turn_to_turn) continue;
    trial.change_m = static_cast<float>((error_m(range_m) - residual_m) / std::sqrt(2.0));
  }
  return trials;
}

TEST(Noise, OfRoundedRangesIsThatBeforeRounding) {
  constexpr double kSigma_m = 0.003;
  for (const bool is_from_turn_to_turn : {true, false}) {
    for (const double steps : {0.1, 1.0, 2.0, 5.0}) {
      SCOPED_TRACE(steps);
      RecordedTrials trials = RoundedTrials(kSigma_m, steps * kSigma_m, is_from_turn_to_turn);
      const FitResult result = FitModel(trials, {});
      EXPECT_EQ(result.noise_from, is_from_turn_to_turn ? NoiseFrom::kTurns : NoiseFrom::kPieces);
      const FittedParameter& whole = result.parameters[0];
      const FittedParameter& at_0 = result.parameters[1];
      EXPECT_EQ(whole.remark.substr(0, 43), "before rounding: the ranges come in steps o");
      EXPECT_NEAR(whole.estimate.value / kSigma_m, 1.0, 0.05);
      EXPECT_NEAR(at_0.estimate.value / kSigma_m, 1.0, 0.1);
      EXPECT_TRUE(Covers(whole.estimate, kSigma_m));
      EXPECT_TRUE(Covers(at_0.estimate, kSigma_m));
      for (const NoiseBin& bin : result.noise_by_range) {
        EXPECT_NEAR(bin.sigma_m.value / kSigma_m, 1.0, 0.4);
      }
    }
  }
}

TEST(Noise, ThatAStepHidesIsNotIdentified) {
  RecordedTrials trials;
  trials.step_m = 0.004;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    trials.noise.push_back({.range_m = 10.0F,
                            .residual_m = 1e-3F * static_cast<float>(i % 3),
                            .change_m = 0.0F,
                            .piece = i / 25});
  }
  const FitResult result = FitModel(trials, {});
  const Estimate& whole = result.parameters[0].estimate;
  EXPECT_EQ(whole.low, 0.0);
  EXPECT_GT(whole.high, 5e-4);
  EXPECT_LT(whole.high, 0.004);
  EXPECT_FALSE(result.parameters[1].estimate.is_enough());
  EXPECT_EQ(result.parameters[1].remark,
            "not identified: the ranges come in steps of 4 mm, which hide the noise");
}

TEST(TakeOutChannels, FindsTheBiasOfEach) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  RecordedTrials trials;
  std::vector<double> biases_m;
  for (int channel = 0; channel < 32; ++channel) biases_m.push_back(0.02 * normal(random));
  for (std::size_t i = 0; i < 32'000; ++i) {
    const double residual_m = biases_m[i % 32] + 0.01 * normal(random);
    trials.noise.push_back({.residual_m = static_cast<float>(residual_m),
                            .channel = static_cast<std::uint16_t>(i % 32)});
  }
  trials.noise.push_back({.residual_m = 1.0F, .channel = 99});
  const ChannelBiases found = TakeOutChannels(trials);
  ASSERT_EQ(found.channels.size(), 32U);
  EXPECT_EQ(trials.noise.back().residual_m, 1.0F);
  for (std::size_t channel = 0; channel < 32; ++channel) {
    // The tolerance is four standard errors of a median of 1000 samples.
    EXPECT_NEAR(found.channels[channel].bias_m.value, biases_m[channel],
                4.0 * 1.2533 * 0.01 / std::sqrt(1000.0));
  }
  EXPECT_LE(found.sigma_m.low, 0.02);
  EXPECT_GE(found.sigma_m.high, 0.02);
}

TEST(TrialSum, KeepsWholeFramesInBoundedMemory) {
  TrialSum sum(100);
  for (int index = 0; index < 1000; ++index) {
    RecordedTrials frame;
    frame.num_frames = frame.num_pieces = 1;
    frame.noise.resize(10, {.range_m = static_cast<float>(index)});
    frame.losses[7] = {1, 0, 7.5};
    sum.Add(frame);
  }
  const RecordedTrials& kept = sum.sum();
  EXPECT_EQ(kept.num_frames, 1000U);
  EXPECT_EQ(kept.losses.at(7).num, 1000U);
  ASSERT_LE(kept.noise.size(), 100U);
  ASSERT_GT(kept.noise.size(), 50U);
  // Every 128th frame is kept, with all ten of its points and the number of its piece.
  for (std::size_t i = 0; i < kept.noise.size(); ++i) {
    EXPECT_EQ(kept.noise[i].range_m, static_cast<float>(i / 10 * 128));
    EXPECT_EQ(kept.noise[i].piece, i / 10 * 128);
  }
}

}  // namespace
}  // namespace railcast
