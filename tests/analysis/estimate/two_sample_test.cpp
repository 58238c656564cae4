#include "analysis/estimate/two_sample.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "analysis/estimate/logistic_model.h"
#include "analysis/estimate/streams.h"

namespace railcast {
namespace {

/// Members of both samples in turn, as many of each in every group.
struct MadeSamples {
  TwoSamples samples;
  std::mt19937 words;
  std::normal_distribution<double> normal{0.0, 1.0};

  MadeSamples(std::uint32_t num_groups, std::uint32_t num_each, int num_features, unsigned seed)
      : words(seed) {
    samples.features.resize(Eigen::Index{2} * num_groups * num_each, num_features);
    for (std::uint32_t group = 0; group < num_groups; ++group) {
      for (std::uint32_t i = 0; i < 2 * num_each; ++i) {
        samples.group.push_back(group);
        samples.is_second.push_back(i % 2 == 1);
      }
    }
    for (double& value : samples.features.reshaped()) value = normal(words);
  }
  [[nodiscard]] bool IsSecond(Eigen::Index row) const {
    return samples.is_second[static_cast<std::size_t>(row)];
  }
};

// Normal features, the first of which is greater by so many standard deviations in the second
// sample.
MadeSamples Shifted(double shift, std::uint32_t num_each, int num_features, unsigned seed) {
  MadeSamples made(10, num_each, num_features, seed);
  for (Eigen::Index row = 0; row < made.samples.features.rows(); ++row) {
    if (made.IsSecond(row)) made.samples.features(row, 0) += shift;
  }
  return made;
}

// The area under the curve of two normal distributions that are apart by so many standard
// deviations: the probability that the difference of their draws, of variance 2, is positive.
double AreaOfShift(double shift) {
  return 0.5 * std::erfc(-shift / 2.0);
}

TEST(AreaUnderCurve, CountsPairsAndTiesHalf) {
  EXPECT_EQ(AreaUnderCurve({1.0, 2.0}, {2.0, 3.0}), 3.5 / 4.0);
  EXPECT_EQ(AreaUnderCurve({5.0}, {5.0, 5.0}), 0.5);
  EXPECT_EQ(AreaUnderCurve({4.0, 3.0}, {1.0}), 0.0);
  EXPECT_TRUE(std::isnan(AreaUnderCurve({}, {1.0})));
}

TEST(AreaUnderCurve, OfShiftedNormalSamplesIsPhiOfTheShiftOverRootTwo) {
  for (const double shift : {0.0, 0.5, 2.0}) {
    MadeSamples made = Shifted(shift, 1000, 1, 1);
    std::vector<double> first, second;
    for (Eigen::Index row = 0; row < made.samples.features.rows(); ++row) {
      (made.IsSecond(row) ? second : first).push_back(made.samples.features(row, 0));
    }
    const double area = AreaOfShift(shift);
    // No area of n and n samples has a standard error above sqrt(area (1 - area) / n).
    EXPECT_NEAR(AreaUnderCurve(first, second), area, 4.0 * std::sqrt(area * (1.0 - area) / 1e4));
  }
}

TEST(TwoSampleTest, FindsTheAreaOfAShift) {
  const MadeSamples made = Shifted(1.0, 200, 1, 1);
  const Estimate area = TwoSampleTest(made.samples).Area();
  // A forest comes near to the best classifier, the feature itself, and cannot surpass it.
  EXPECT_NEAR(area.value, AreaOfShift(1.0), 0.02);
  EXPECT_GT(area.high, AreaOfShift(1.0) - 0.01);
  EXPECT_EQ(area.num, 10U);
}

// Limits for how many of `num` intervals of 95 % hold: 4 standard errors of the binomial.
void ExpectCoverage(int num_holding, int num) {
  const double error = std::sqrt(0.95 * 0.05 / num);
  EXPECT_NEAR(static_cast<double>(num_holding) / num, 0.95, 4.0 * error);
}

TEST(TwoSampleTest, HoldsAHalfIn95PercentOfEqualSamples) {
  constexpr int kNum = 120;
  int num_holding = 0;
  Moments areas;
  for (unsigned seed = 0; seed < kNum; ++seed) {
    const MadeSamples made = Shifted(0.0, 10, 2, seed);
    const Estimate area = TwoSampleTest(made.samples).Area();
    areas.Add(area.value);
    num_holding += area.low <= 0.5 && area.high >= 0.5 ? 1 : 0;
  }
  ExpectCoverage(num_holding, kNum);
  const Estimate mean = areas.Mean();
  EXPECT_LT(mean.low, 0.5);  // Unbiased.
  EXPECT_GT(mean.high, 0.5);
}

// What the members of a group have in common makes a group's area err as a whole.
TEST(TwoSampleTest, HoldsTheExpectedAreaIn95PercentOfSamplesInGroups) {
  constexpr int kNum = 120;
  std::vector<Estimate> areas;
  Moments means;
  for (unsigned seed = 0; seed < kNum; ++seed) {
    MadeSamples made = Shifted(1.0, 10, 1, seed);
    std::vector<double> common(20);
    for (double& value : common) value = made.normal(made.words);
    for (Eigen::Index row = 0; row < made.samples.features.rows(); ++row) {
      const std::size_t group = made.samples.group[static_cast<std::size_t>(row)];
      made.samples.features(row, 0) += common[2 * group + (made.IsSecond(row) ? 1 : 0)];
    }
    areas.push_back(TwoSampleTest(made.samples).Area());
    means.Add(areas.back().value);
  }
  const double expected = means.PlainMean();
  ExpectCoverage(
      static_cast<int>(std::ranges::count_if(
          areas, [&](const Estimate& e) { return e.low <= expected && e.high >= expected; })),
      kNum);
}

TEST(TwoSampleTest, NeverHasAGroupInBothParts) {
  // A value that names group and sample: whoever has seen it knows all.
  MadeSamples made(20, 20, 1, 3);
  std::vector<double> names(40);
  for (double& name : names) name = made.normal(made.words);
  for (Eigen::Index row = 0; row < made.samples.features.rows(); ++row) {
    const std::size_t group = made.samples.group[static_cast<std::size_t>(row)];
    made.samples.features(row, 0) = names[2 * group + (made.IsSecond(row) ? 1 : 0)];
  }
  const Estimate area = TwoSampleTest(made.samples).Area();
  EXPECT_LT(area.low, 0.5);
  EXPECT_GT(area.high, 0.5);
}

// Two normal features of one mean, one sample with twice the standard deviation: no plane parts
// them. The best score of one such feature is its size, whose area is 2 / pi atan 2.
TEST(TwoSampleTest, TellsTwiceTheNoiseWhichALogisticModelCannot) {
  MadeSamples made(10, 100, 1, 1);
  for (Eigen::Index row = 0; row < made.samples.features.rows(); ++row) {
    if (made.IsSecond(row)) made.samples.features(row, 0) *= 2.0;
  }
  const double best = 2.0 / std::numbers::pi * std::atan(2.0);
  EXPECT_NEAR(TwoSampleTest(made.samples).Area().value, best, 0.04);

  const Eigen::Index num = made.samples.features.rows(), half = num / 2;
  Eigen::MatrixXd x = Eigen::MatrixXd::Ones(num, 2);
  x.col(1) = made.samples.features.col(0);
  Eigen::VectorXd y(half);
  for (Eigen::Index row = 0; row < half; ++row) y[row] = made.IsSecond(row) ? 1.0 : 0.0;
  const LogisticModel model = FitLogistic(x.topRows(half), y, {true, true});
  std::vector<double> first, second;
  for (Eigen::Index row = half; row < num; ++row) {
    (made.IsSecond(row) ? second : first).push_back(x.row(row) * model.coefficients);
  }
  EXPECT_NEAR(AreaUnderCurve(first, second), 0.5, 4.0 * 0.5 / std::sqrt(500.0));
}

TEST(TwoSampleTest, FindsTheFeatureThatTells) {
  const MadeSamples made = Shifted(1.5, 40, 4, 1);
  const TwoSampleTest test(made.samples);
  EXPECT_GT(test.importances()[0].low, 0.2);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_NEAR(test.importances()[i].value, 0.0, 0.03) << i;
}

TEST(TwoSampleTest, TellsByWhatIsMissing) {
  MadeSamples made(10, 20, 2, 1);
  for (Eigen::Index row = 0; row < made.samples.features.rows(); ++row) {
    if (made.IsSecond(row)) {
      made.samples.features(row, 1) = std::numeric_limits<double>::quiet_NaN();
    }
  }
  const TwoSampleTest test(made.samples);
  EXPECT_GT(test.Area().value, 0.99);
  EXPECT_GT(test.BalancedAccuracy().value, 0.95);
}

TEST(TwoSampleTest, CountsOnlyThoseThatTakePart) {
  MadeSamples made(10, 40, 1, 1);
  // Every second pair differs by far.
  for (Eigen::Index row = 0; row < made.samples.features.rows(); ++row) {
    made.samples.features(row, 0) = row / 2 % 2 == 0 ? 0.0 : made.IsSecond(row) ? 1.0 : -1.0;
  }
  const TwoSampleTest test(made.samples);
  EXPECT_EQ(test.Area([](std::size_t i) { return i / 2 % 2 == 0; }).value, 0.5);
  EXPECT_EQ(test.Area([](std::size_t i) { return i / 2 % 2 == 1; }).value, 1.0);
  EXPECT_EQ(test.Area().value, 0.875);
  EXPECT_FALSE(test.Area([](std::size_t i) { return i < 80; }).is_enough());
}

TEST(TwoSampleTest, WantsTenGroupsWithBothSamples) {
  const MadeSamples nine(9, 100, 2, 1);
  const TwoSampleTest test(nine.samples);
  EXPECT_FALSE(test.is_enough());
  EXPECT_FALSE(test.Area().is_enough());
  EXPECT_FALSE(test.BalancedAccuracy().is_enough());
  EXPECT_FALSE(test.importances().front().is_enough());

  MadeSamples of_one(10, 100, 2, 1);
  for (std::size_t i = 0; i < 200; ++i) of_one.samples.is_second[i] = true;
  EXPECT_FALSE(TwoSampleTest(of_one.samples).is_enough());
  const MadeSamples one_each(10, 1, 2, 1);
  EXPECT_TRUE(TwoSampleTest(one_each.samples).is_enough());
}

TEST(TwoSampleTest, IsTheSameAtAnyNumberOfThreads) {
  const MadeSamples made = Shifted(0.3, 30, 5, 1);
  const auto figures = [&](std::size_t num_threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, num_threads);
    const TwoSampleTest test(made.samples);
    std::vector<double> values = {test.Area().value, test.Area().low};
    for (const Estimate& importance : test.importances()) values.push_back(importance.value);
    return values;
  };
  const std::vector<double> one = figures(1);
  EXPECT_EQ(figures(2), one);
  EXPECT_EQ(figures(7), one);
}

TEST(RandomForest, DoesNotFavourTheLargerSample) {
  MadeSamples made(1, 300, 2, 1);
  // A tenth of the second sample is left.
  std::vector<Eigen::Index> kept;
  std::vector<bool> is_second;
  for (Eigen::Index row = 0; row < made.samples.features.rows(); ++row) {
    if (made.IsSecond(row) && row % 20 != 1) continue;
    kept.push_back(row);
    is_second.push_back(made.IsSecond(row));
  }
  const RandomForest forest(made.samples.features(kept, Eigen::all), is_second, 0);
  double sum = 0.0;
  const std::vector<double> scores = forest.Scores(MadeSamples(1, 1000, 2, 2).samples.features);
  for (const double score : scores) sum += score;
  EXPECT_NEAR(sum / static_cast<double>(scores.size()), 0.5, 0.1);
}

}  // namespace
}  // namespace railcast
