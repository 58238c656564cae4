#include "analysis/extras/rare/rare_event.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "core/base/random.h"

namespace railcast {
namespace {

constexpr std::uint32_t kNumEstimates = 200;

double NormalTail(double z) {
  return 0.5 * std::erfc(z / std::numbers::sqrt2);
}

// Ten normal numbers fail if the sum of the first five, or that of the others, is too great: two
// modes far apart. Both sums are normal with the variance 5.
constexpr double kThreshold = 3.891;  // 1 - (1 - 5.0e-5)^2 = 1.0e-4.
double ToyScore(const RarePoint& point) {
  double first = 0.0;
  double second = 0.0;
  for (std::size_t i = 0; i < 5; ++i) {
    first += point[i];
    second += point[5 + i];
  }
  return kThreshold - std::max(first, second) / std::sqrt(5.0);
}
double ToyProbability() {
  const double passes = 1.0 - NormalTail(kThreshold);
  return 1.0 - passes * passes;
}

// The cheap level fails at other points, a tenth of a standard deviation off.
double CheapToyScore(const RarePoint& point) {
  return ToyScore(point) + 0.1 * std::sin(10.0 * point[0]);
}

RareExperiment ToyExperiment() {
  return [](const std::vector<RareTrial>& trials) {
    std::vector<RareScores> scores;
    for (const RareTrial& trial : trials) {
      scores.push_back({CheapToyScore(trial.point)});
      if (trial.is_pair) scores.back().dear = ToyScore(trial.point);
    }
    return std::optional(scores);
  };
}

/// What came of many estimates with different seeds.
struct RareCoverage {
  std::uint32_t num_known = 0;
  std::uint32_t num_covering = 0;
  double mean = 0.0;
  double trials = 0.0;        // Of all.
  double plain_trials = 0.0;  // For intervals as wide.
};

RareCoverage CoverageOf(const std::vector<RareFactor>& factors,
                        RareSettings settings,
                        const RareExperiment& experiment,
                        double probability,
                        std::uint32_t num_estimates = kNumEstimates) {
  RareCoverage coverage;
  for (std::uint32_t i = 0; i < num_estimates; ++i) {
    settings.seed = 1000 + i * 1'000'003ULL;
    const auto run = RunRareEvent(factors, settings, experiment);
    const RareFigure& figure = run->figure;
    if (!figure.is_known()) continue;
    coverage.trials += static_cast<double>(run->trials.size());
    coverage.plain_trials += PlainTrialsFor(figure.probability);
    ++coverage.num_known;
    coverage.mean += figure.probability.value;
    const bool covers =
        figure.probability.low <= probability && probability <= figure.probability.high;
    coverage.num_covering += covers ? 1U : 0U;
  }
  coverage.mean /= coverage.num_known;
  return coverage;
}

TEST(RareEvent, CoversAProbabilityOfTwoModesInTenDimensions) {
  const double probability = ToyProbability();
  EXPECT_NEAR(probability, 1e-4, 1e-6);
  const RareCoverage coverage =
      CoverageOf(std::vector<RareFactor>(10), {.num_per_stage = 600, .has_pairs = true},
                 ToyExperiment(), probability);
  EXPECT_GE(coverage.num_known, 9 * kNumEstimates / 10);
  EXPECT_GE(coverage.num_covering, 0.93 * coverage.num_known);
  // The mean of so many has an error of about 1 %.
  EXPECT_NEAR(coverage.mean, probability, 0.04 * probability);
}

// A number in the middle of its range, of which a share fails whatever all else is: no score leads
// there.
bool IsInIsland(double score, double share) {
  return std::abs(NormalTail(score) - 0.3) < 0.5 * share;
}

/// Scores of one level, of the point and the number of a trial.
RareExperiment OneLevel(const std::function<double(const RarePoint&, std::uint32_t)>& score) {
  return [score](const std::vector<RareTrial>& trials) {
    std::vector<RareScores> scores;
    for (const RareTrial& trial : trials) scores.push_back({score(trial.point, trial.index)});
    return std::optional(scores);
  };
}

constexpr double kTailThreshold = 2.8782;  // Of 0.002.

TEST(RareEvent, HoldsFailuresToWhichNoScoreLeads) {
  // By what the searches find alone, 21 and 55 % of the intervals cover. Those that do not rule out
  // what was not met cover more than they must.
  constexpr std::uint32_t kNum = 100;
  const double probability = 1.0 - (1.0 - 0.002) * (1.0 - 0.001);
  const auto island = [](const RarePoint& point, std::uint32_t) {
    return IsInIsland(point[1], 0.001) ? -1.0 : kTailThreshold - point[0];
  };
  const auto option = [](const RarePoint& point, std::uint32_t) {
    return point[1] == 1.0 ? -1.0 : kTailThreshold - point[0];
  };
  const RareCoverage of_island =
      CoverageOf(std::vector<RareFactor>(3), {}, OneLevel(island), probability, kNum);
  const RareCoverage of_option = CoverageOf({{}, {.probabilities = {0.999, 0.001}}, {}}, {},
                                            OneLevel(option), probability, kNum);
  for (const RareCoverage& coverage : {of_island, of_option}) {
    EXPECT_GE(coverage.num_known, 0.9 * kNum);
    EXPECT_GE(coverage.num_covering, 0.93 * coverage.num_known);
    EXPECT_NEAR(coverage.mean, probability, 2e-4);
    EXPECT_LE(coverage.trials, 9000.0 * coverage.num_known);
  }
}

TEST(RareEvent, HoldsFailuresOfTheDearLevelAlone) {
  // Of pairs by a proposal alone, none covers, and 60 of 100 seeds have a figure.
  constexpr std::uint32_t kNum = 100;
  const double probability = 1.0 - (1.0 - 0.002) * (1.0 - 0.004);
  const RareExperiment experiment = [](const std::vector<RareTrial>& trials) {
    std::vector<RareScores> scores;
    for (const RareTrial& trial : trials) {
      scores.push_back({kTailThreshold - trial.point[0]});
      if (!trial.is_pair) continue;
      scores.back().dear = IsInIsland(trial.point[1], 0.004) ? -1.0 : scores.back().cheap;
    }
    return std::optional(scores);
  };
  const RareCoverage coverage =
      CoverageOf(std::vector<RareFactor>(3), {.has_pairs = true}, experiment, probability, kNum);
  EXPECT_GE(coverage.num_known, 0.9 * kNum);
  EXPECT_GE(coverage.num_covering, 0.93 * coverage.num_known);
  EXPECT_NEAR(coverage.mean, probability, 4e-4);
}

TEST(RareEvent, TriesAsManyByTheirOwnLawAsAreAskedFor) {
  const auto score = [](const RarePoint& point, std::uint32_t) {
    return kTailThreshold - point[0];
  };
  for (const double unseen : {3e-3, 1e-3}) {
    const auto run =
        RunRareEvent(std::vector<RareFactor>(3), {.seed = 5, .unseen = unseen}, OneLevel(score));
    const RareFigure& figure = run->figure;
    ASSERT_TRUE(figure.is_known()) << figure.refusal;
    EXPECT_GE(static_cast<double>(figure.beyond.num), 3.0 / unseen);
    EXPECT_LE(static_cast<double>(figure.beyond.num), 3.0 / unseen + 200.0);
    EXPECT_EQ(figure.beyond.num_more, 0U);
    // Clopper and Pearson's end of none in n: 1 - 0.025^(1 / n).
    const double none = 1.0 - std::pow(0.025, 1.0 / static_cast<double>(figure.beyond.num));
    EXPECT_NEAR(figure.beyond.share.high, none, 1e-9);
    EXPECT_NEAR(figure.probability.high - figure.probability.value,
                std::hypot(figure.met.high - figure.met.value, none), 1e-9);
    EXPECT_EQ(figure.probability.low, figure.met.low);
  }
}

TEST(RareEvent, CoversAProbabilityOfWhichASearchMayMissHalf) {
  // A hundred trials of a stage often find but one of the two modes: by the weights of one proposal
  // alone, 87 % of the intervals cover.
  constexpr double kLowThreshold = 2.5750;  // 1 - (1 - 5.012e-3)^2 = 0.01.
  const double passes = 1.0 - NormalTail(kLowThreshold);
  const auto score = [](const RarePoint& point, std::uint32_t) {
    return ToyScore(point) + kLowThreshold - kThreshold;
  };
  const RareCoverage coverage = CoverageOf(std::vector<RareFactor>(10), {.num_per_stage = 100},
                                           OneLevel(score), 1.0 - passes * passes);
  EXPECT_GE(coverage.num_known, 9 * kNumEstimates / 10);
  EXPECT_GE(coverage.num_covering, 0.93 * coverage.num_known);
  EXPECT_NEAR(coverage.mean, 1.0 - passes * passes, 3e-4);
  EXPECT_LE(1.5 * coverage.trials, coverage.plain_trials);
}

TEST(RareEvent, CoversAProbabilityWhereNoiseDecidesToo) {
  // The noise makes some trials fail that no proposal favours: great weights, of which the upper
  // end of the interval must know; with it as great as the factor, no proposal may help at all.
  constexpr std::uint32_t kNum = 200;
  for (const double noise : {0.5, 1.0}) {
    const double threshold = 2.3263 * std::hypot(1.0, noise);  // P = 0.01.
    const auto score = [&](const RarePoint& point, std::uint32_t index) {
      // Of its own in each run, since the point is.
      const auto key = std::bit_cast<std::uint64_t>(point[0]);
      const auto words = RandomWords(key, RandomUse::kNoise, 0, index);
      const double one = UnitFloat(words[0]);
      const double other = UnitFloat(words[1]);
      const double radius = std::sqrt(-2.0 * std::log(1.0 - one));
      const double normal = radius * std::cos(2.0 * std::numbers::pi * other);
      return threshold - point[0] - noise * normal;
    };
    const RareCoverage coverage =
        CoverageOf(std::vector<RareFactor>(3), {.num_per_stage = 100}, OneLevel(score), 0.01, kNum);
    EXPECT_GE(coverage.num_known, 0.98 * kNum) << noise;
    EXPECT_GE(coverage.num_covering, 0.93 * coverage.num_known) << noise;
  }
}

// A box on a plane in fog: the power that comes back falls as exp(-2 a r) / r^2, so that the box is
// seen in time where the visibility exceeds a threshold, which depends on its reflectance. The fog
// counts only where the weather is fog.
constexpr double kNeeded_m = 60.0;
constexpr double kLeastVisibility_m = 40.0;
constexpr double kMostVisibility_m = 4000.0;
double VisibilityOf(double quantile) {
  return kLeastVisibility_m * std::pow(kMostVisibility_m / kLeastVisibility_m, quantile);
}
double QuantileOf(double score) {
  return 1.0 - NormalTail(score);
}
// ln of the received power over the threshold of detection, at the needed distance.
double FogScore(const RarePoint& point) {
  const bool is_fog = point[0] == 1.0;
  const double extinction_per_m =
      is_fog ? 3.0 / VisibilityOf(QuantileOf(point[1])) : 0.0;  // Koschmieder.
  const double reflectance = 0.02 + 0.6 * QuantileOf(point[2]);
  return std::log(reflectance / 0.02) - 2.0 * extinction_per_m * kNeeded_m + 6.0;
}
double FogProbability() {
  constexpr int kNumSteps = 100'000;
  double sum = 0.0;
  for (int i = 0; i < kNumSteps; ++i) {
    const double log_reflectance = std::log(1.0 + 30.0 * (i + 0.5) / kNumSteps);
    const double visibility_m = 6.0 * kNeeded_m / (6.0 + log_reflectance);
    sum += std::clamp(std::log(visibility_m / kLeastVisibility_m) /
                          std::log(kMostVisibility_m / kLeastVisibility_m),
                      0.0, 1.0);
  }
  return 0.1 * sum / kNumSteps;
}

TEST(RareEvent, CoversTheProbabilityOfABoxInFog) {
  const std::vector<RareFactor> factors = {
      {.probabilities = {0.9, 0.1}}, {.only_with = RareFactor::Condition{0, 1}}, {}};
  const auto score = [](const RarePoint& point, std::uint32_t) { return FogScore(point); };
  const RareCoverage coverage =
      CoverageOf(factors, {.num_per_stage = 200}, OneLevel(score), FogProbability());
  EXPECT_GE(coverage.num_known, 9 * kNumEstimates / 10);
  EXPECT_GE(coverage.num_covering, 0.93 * coverage.num_known);
}

TEST(RareEvent, CostsNoMoreThanPlainTrialsWhereFailuresAreFrequent) {
  const auto score = [](const RarePoint& point, std::uint32_t) { return point[0] + 1.1503; };
  const RareCoverage coverage = CoverageOf(std::vector<RareFactor>(2), {.num_per_stage = 200},
                                           OneLevel(score), NormalTail(1.1503));
  EXPECT_EQ(coverage.num_known, kNumEstimates);
  EXPECT_GE(coverage.num_covering, 0.93 * coverage.num_known);
  EXPECT_LE(coverage.trials, 1.05 * coverage.plain_trials);
}

TEST(RareEvent, CostsLittleMoreThanPlainTrialsWhereNoFactorDecides) {
  // What fails has nothing to do with the factors.
  const RareExperiment experiment = OneLevel([](const RarePoint&, std::uint32_t index) {
    const double unit = UnitFloat(RandomWords(7, RandomUse::kNoise, 0, index)[0]);
    return unit - 0.02;
  });
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    const auto run = RunRareEvent(std::vector<RareFactor>(2),
                                  {.seed = seed * 1'000'003, .num_per_stage = 100}, experiment);
    const Estimate& probability = run->figure.probability;
    ASSERT_TRUE(run->figure.is_known()) << run->figure.refusal;
    EXPECT_LT(probability.low, 0.02);
    EXPECT_GT(probability.high, 0.02);
    EXPECT_LE(static_cast<double>(run->trials.size()), 3.0 * PlainTrialsFor(probability));
  }
}

TEST(RareEvent, KnowsWhatTheCheapLevelIsBlindTo) {
  // What fails on the dear level, 0.02 of all, has nothing to do with the few failures to which the
  // cheap one leads. All are drawn as they come, so that the searches need not be sound.
  constexpr std::uint32_t kNum = 20;
  const RareExperiment experiment = [](const std::vector<RareTrial>& trials) {
    std::vector<RareScores> scores;
    for (const RareTrial& trial : trials) {
      scores.push_back({ToyScore(trial.point)});
      if (trial.is_pair) scores.back().dear = trial.point[9] < -2.054 ? -1.0 : 1.0;
    }
    return std::optional(scores);
  };
  const RareCoverage coverage =
      CoverageOf(std::vector<RareFactor>(10), {.has_pairs = true}, experiment, 0.02, kNum);
  EXPECT_GE(coverage.num_known, 0.9 * kNum);
  EXPECT_GE(coverage.num_covering, 0.9 * coverage.num_known);
  // No rule of searches drives them to the most trials that there may be.
  EXPECT_LE(coverage.trials, 12'000.0 * coverage.num_known);
}

TEST(RareEvent, KnowsWhatOnlyTheDearLevelSees) {
  // The cheap level never fails, whatever a search leads to.
  constexpr std::uint32_t kNum = 10;
  for (const double unseen : {1e-3, 2e-3}) {
    for (const double threshold : {2.6521, 2.0537}) {  // Of 0.004 and 0.02.
      const RareExperiment experiment = [&](const std::vector<RareTrial>& trials) {
        std::vector<RareScores> scores;
        for (const RareTrial& trial : trials) {
          scores.push_back({0.5 + NormalTail(trial.point[0])});
          if (trial.is_pair) scores.back().dear = threshold - trial.point[1];
        }
        return std::optional(scores);
      };
      const RareCoverage coverage = CoverageOf(
          std::vector<RareFactor>(2), {.precision = 0.6, .unseen = unseen, .has_pairs = true},
          experiment, NormalTail(threshold), kNum);
      EXPECT_GE(coverage.num_known, 0.9 * kNum) << unseen << " " << threshold;
      EXPECT_GE(coverage.num_covering, 0.8 * coverage.num_known) << unseen << " " << threshold;
    }
  }
}

TEST(RareEvent, KnowsFailuresHoweverFrequentAndHoweverManyAreDrawnAsTheyCome) {
  constexpr std::uint32_t kNum = 10;
  double num_known = 0.0;
  double num_covering = 0.0;
  for (const double threshold : {2.8782, 1.7507, 1.5548, 0.5244}) {  // 0.002, 0.04, 0.06 and 0.3.
    const double probability = NormalTail(threshold);
    for (const bool has_pairs : {false, true}) {
      const RareExperiment experiment = [&](const std::vector<RareTrial>& trials) {
        std::vector<RareScores> scores;
        for (const RareTrial& trial : trials) {
          const double score = threshold - trial.point[0];
          scores.push_back({score + (has_pairs ? 0.1 * std::sin(10.0 * trial.point[1]) : 0.0)});
          if (trial.is_pair) scores.back().dear = score;
        }
        return std::optional(scores);
      };
      for (const double unseen : {1e-2, 1e-3}) {
        const RareCoverage coverage =
            CoverageOf(std::vector<RareFactor>(2), {.unseen = unseen, .has_pairs = has_pairs},
                       experiment, probability, kNum);
        SCOPED_TRACE(std::to_string(probability) + (has_pairs ? " pairs " : " ") +
                     std::to_string(unseen));
        EXPECT_GE(coverage.num_known, 0.9 * kNum);
        // Four standard errors of the mean of ten, where half an interval is 0.3 of each.
        EXPECT_NEAR(coverage.mean, probability, 0.2 * probability);
        // Nothing that was drawn is thrown away for more of the same.
        EXPECT_LE(coverage.trials, (3.0 / unseen + 3500.0) * coverage.num_known);
        num_known += coverage.num_known;
        num_covering += coverage.num_covering;
      }
    }
  }
  EXPECT_GE(num_covering, 0.9 * num_known);
}

TEST(RareEvent, TriesAsManyAsAreAskedForWhereAllAreDrawnByTheirOwnLaw) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  for (const double unseen : {3e-3, 1e-3}) {
    for (const double share : {0.06, 0.3, 1.0}) {
      const auto score = [&](const RarePoint& point, std::uint32_t) {
        return NormalTail(point[0]) - share;
      };
      const auto run =
          RunRareEvent(std::vector<RareFactor>(1), {.seed = 2, .unseen = unseen}, OneLevel(score));
      ASSERT_TRUE(run->figure.is_plain) << share;
      EXPECT_EQ(static_cast<double>(run->figure.cheap.num), 3.0 / unseen) << share;
    }
    for (const bool has_pairs : {false, true}) {
      const auto run =
          RunRareEvent(std::vector<RareFactor>(1), {.unseen = unseen, .has_pairs = has_pairs},
                       [&](const std::vector<RareTrial>& trials) {
                         return std::optional(
                             std::vector<RareScores>(trials.size(), RareScores{kNever, kNever}));
                       });
      EXPECT_NEAR(run->figure.at_most, 3.689 * unseen / 3.0, 0.01 * unseen) << has_pairs;
    }
  }
}

TEST(RareEvent, BoundsWhatNeverFailed) {
  const RareExperiment experiment = [](const std::vector<RareTrial>& trials) {
    return std::optional(std::vector<RareScores>(trials.size(), RareScores{1.0}));
  };
  const auto run = RunRareEvent(std::vector<RareFactor>(2), {.num_per_stage = 200}, experiment);
  EXPECT_EQ(run->figure.refusal, "nothing failed");
  // As many as all others; the exact two-sided bound of none is 3.69.
  EXPECT_GE(2 * run->figure.beyond.num, run->trials.size());
  EXPECT_NEAR(run->figure.at_most, 3.689 / static_cast<double>(run->figure.beyond.num), 1e-4);
}

TEST(RareEvent, MakesNoMoreTrialsThanAreAllowed) {
  for (const bool has_pairs : {false, true}) {
    const auto run = RunRareEvent(
        std::vector<RareFactor>(10),
        {.num_per_stage = 100, .precision = 0.01, .most_trials = 1000, .has_pairs = has_pairs},
        ToyExperiment());
    EXPECT_LE(run->trials.size(), 1000U);
    EXPECT_GE(run->trials.size(), 990U);
  }
}

TEST(RareEvent, EndsWhereTheExperimentIsStopped) {
  int num_batches = 0;
  const RareExperiment toy = ToyExperiment();
  const RareExperiment experiment = [&](const std::vector<RareTrial>& trials) {
    return ++num_batches < 3 ? toy(trials) : std::nullopt;
  };
  EXPECT_FALSE(RunRareEvent(std::vector<RareFactor>(10), {}, experiment));
  EXPECT_EQ(num_batches, 3);
}

}  // namespace
}  // namespace railcast
