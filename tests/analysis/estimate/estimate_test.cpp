#include "analysis/estimate/estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "analysis/estimate/streams.h"

namespace railcast {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kRuns = 2000;
// Of 2000 intervals that hold the truth with a probability of 95 %, 1900 +- 4 x 9.7 do.
constexpr int kLeastHits = 1861;
constexpr int kMostHits = 1939;

bool Holds(const Estimate& estimate, double truth) {
  return estimate.low <= truth && truth <= estimate.high;
}

std::vector<double> Normals(std::mt19937_64& random, std::size_t num, double mean, double sigma) {
  std::normal_distribution<double> normal(mean, sigma);
  std::vector<double> samples(num);
  for (double& sample : samples) sample = normal(random);
  return samples;
}

Moments MomentsOf(const std::vector<double>& samples) {
  Moments moments;
  for (const double sample : samples) moments.Add(sample);
  return moments;
}

TEST(Proportion, HoldsTheTruthAsOftenAsItSays) {
  std::mt19937_64 random(1);
  std::binomial_distribution<std::uint64_t> draw(200, 0.1);
  int hits = 0;
  for (int run = 0; run < kRuns; ++run) hits += Holds(Proportion(draw(random), 200), 0.1) ? 1 : 0;
  // The coverage of Wilson's interval is off by up to 2 % for particular p and n.
  EXPECT_NEAR(hits, 0.95 * kRuns, 0.025 * kRuns);
}

TEST(Proportion, StaysBetweenNoneAndAll) {
  const Estimate none = Proportion(0, 50);
  EXPECT_EQ(none.value, 0.0);
  EXPECT_EQ(none.low, 0.0);
  EXPECT_NEAR(none.high, 0.0713, 1e-3);  // z^2 / (n + z^2)
  const Estimate all = Proportion(50, 50);
  EXPECT_EQ(all.high, 1.0);
  EXPECT_NEAR(all.low, 1.0 - 0.0713, 1e-3);
}

TEST(Proportion, AgreesWithWilsonsPublishedExample) {
  // 81 of 263 (Newcombe 1998, Statistics in Medicine 17, table I): 0.2553 to 0.3662.
  const Estimate estimate = Proportion(81, 263);
  EXPECT_NEAR(estimate.low, 0.2553, 5e-5);
  EXPECT_NEAR(estimate.high, 0.3662, 5e-5);
}

TEST(PoissonRate, HasGarwoodsLimits) {
  const Estimate estimate = PoissonRate(10, 2.0);
  EXPECT_EQ(estimate.value, 5.0);
  EXPECT_NEAR(estimate.low, 4.795 / 2.0, 1e-3);
  EXPECT_NEAR(estimate.high, 18.390 / 2.0, 1e-3);
  EXPECT_FALSE(PoissonRate(9, 2.0).is_enough());
  EXPECT_FALSE(PoissonRate(10, 0.0).is_enough());
}

TEST(Moments, HoldTheTruthAsOftenAsTheySay) {
  std::mt19937_64 random(2);
  int mean_hits = 0;
  int deviation_hits = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Moments moments = MomentsOf(Normals(random, 12, 3.0, 0.5));
    mean_hits += Holds(moments.Mean(), 3.0) ? 1 : 0;
    deviation_hits += Holds(moments.StandardDeviation(), 0.5) ? 1 : 0;
  }
  EXPECT_GE(mean_hits, kLeastHits);
  EXPECT_LE(mean_hits, kMostHits);
  EXPECT_GE(deviation_hits, kLeastHits);
  EXPECT_LE(deviation_hits, kMostHits);
}

TEST(Moments, OfPartsAreThoseOfTheWhole) {
  std::mt19937_64 random(3);
  // With a large mean and a small deviation, sums of squares would lose all digits.
  const std::vector<double> samples = Normals(random, 1000, 1e6, 1e-3);
  Moments parts = MomentsOf({samples.begin(), samples.begin() + 1});
  parts.Add(MomentsOf({}));
  parts.Add(MomentsOf({samples.begin() + 1, samples.begin() + 400}));
  parts.Add(MomentsOf({samples.begin() + 400, samples.end()}));
  const Moments whole = MomentsOf(samples);
  EXPECT_EQ(parts.num(), 1000U);
  EXPECT_NEAR(parts.Mean().value, whole.Mean().value, 1e-9);
  EXPECT_NEAR(parts.StandardDeviation().value, whole.StandardDeviation().value, 1e-9);
  EXPECT_NEAR(whole.StandardDeviation().value, 1e-3, 1e-4);
}

TEST(Estimators, GiveNoNumberForTooFewSamples) {
  for (const std::size_t num : {0U, 1U, 2U, 9U}) {
    std::vector<double> samples(num, 1.0);
    EXPECT_FALSE(Proportion(0, num).is_enough());
    EXPECT_FALSE(MomentsOf(samples).Mean().is_enough());
    EXPECT_FALSE(MomentsOf(samples).StandardDeviation().is_enough());
    EXPECT_FALSE(Median(samples).is_enough());
    EXPECT_FALSE(RobustScale(samples).is_enough());
    LogHistogram histogram;
    for (const double sample : samples) histogram.Add(sample);
    EXPECT_FALSE(histogram.Median().is_enough());
    EXPECT_EQ(MomentsOf(samples).Mean().num, num);
    EXPECT_TRUE(std::isnan(Proportion(0, num).low));
  }
  EXPECT_FALSE(FitPowerLaw({{1, 1, 0.1}, {2, 4, 0.1}, {3, 9, 0.1}}).exponent.is_enough());
}

TEST(Estimators, TakeNaNForNoSample) {
  std::vector<double> samples(20, kNaN);
  EXPECT_EQ(MomentsOf(samples).Mean().num, 0U);
  EXPECT_FALSE(Median(samples).is_enough());
  samples.assign(20, kNaN);
  samples.insert(samples.end(), 15, 2.0);
  EXPECT_EQ(Median(samples).value, 2.0);
  EXPECT_EQ(Median(samples).num, 15U);
  LogHistogram histogram;
  histogram.Add(kNaN);
  EXPECT_EQ(histogram.num(), 0U);
  EXPECT_FALSE(histogram.Median().is_enough());
}

TEST(RobustEstimators, HoldTheTruthAsOftenAsTheySay) {
  std::mt19937_64 random(4);
  int median_hits = 0;
  int scale_hits = 0;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<double> samples = Normals(random, 200, 3.0, 0.5);
    median_hits += Holds(Median(samples), 3.0) ? 1 : 0;
    scale_hits += Holds(RobustScale(samples), 0.5) ? 1 : 0;
  }
  // The ranks of the median's interval are rounded outwards, so its coverage may be higher.
  EXPECT_GE(median_hits, kLeastHits);
  EXPECT_NEAR(scale_hits, 0.95 * kRuns, 0.02 * kRuns);
}

TEST(RobustEstimators, StandWhereOutliersSpoilThePlainOnes) {
  std::mt19937_64 random(5);
  std::vector<double> samples = Normals(random, 900, 3.0, 0.5);
  samples.insert(samples.end(), 100, 1000.0);
  const Moments plain = MomentsOf(samples);
  EXPECT_GT(plain.Mean().value, 50.0);
  EXPECT_GT(plain.StandardDeviation().value, 100.0);
  EXPECT_NEAR(Median(samples).value, 3.0, 0.15);
  EXPECT_NEAR(RobustScale(samples).value, 0.5, 0.1);
}

// Samples with more far from the middle than normal ones, as those of what moves.
TEST(RobustEstimators, HardlyMoveWithStepsFinerThanHalfTheSpread) {
  for (const double step : {0.02, 0.1, 0.3, 0.4}) {
    for (const double shift : {0.0, 0.37, -2.5}) {
      std::mt19937_64 random(12);
      std::exponential_distribution<double> draw;
      std::uniform_real_distribution<double> mean(0.0, 100.0);
      std::vector<double> samples;
      RoundedSamples of_both(step), of_one(step);
      for (int i = 0; i < 20000; ++i) {
        samples.push_back(shift + (i % 2 == 0 ? draw(random) : -draw(random)));
        const double at = mean(random);
        const double rounded = step * std::round((at + samples.back()) / step);
        of_both.Add(rounded - step * std::round(at / step));
        of_one.Add(rounded - at);
      }
      const Estimate plain = RobustScale(samples);
      for (const Estimate& seen :
           {RobustScale(of_both, RoundedValues::kBoth), RobustScale(of_one, RoundedValues::kOne)}) {
        EXPECT_NEAR(seen.value / plain.value, 1.0, 0.04) << step;
        EXPECT_NEAR((seen.high - seen.low) / (plain.high - plain.low), 1.0, 0.04) << step;
        EXPECT_EQ(seen.num, plain.num);
      }
    }
  }
}

TEST(LogHistogram, HasTheMedianOfItsSamplesToHalfAPercent) {
  std::mt19937_64 random(6);
  std::lognormal_distribution<double> draw(-3.0, 1.0);
  LogHistogram histogram, part;
  for (int i = 0; i < 20000; ++i) (i % 3 == 0 ? part : histogram).Add(draw(random));
  histogram.Add(part);
  histogram.Add(LogHistogram());
  const Estimate median = histogram.Median();
  const double truth = std::exp(-3.0);
  // The standard error of the median is 1.25 sigma / sqrt(n) = 0.9 %.
  EXPECT_NEAR(median.value / truth, 1.0, 0.035);
  EXPECT_TRUE(Holds(median, median.value));
  EXPECT_EQ(median.num, 20000U);
  EXPECT_NEAR(histogram.Quantile(0.8413).value / std::exp(-2.0), 1.0, 0.05);
}

TEST(LogHistogram, KnowsZerosAndNegativeNumbers) {
  LogHistogram zeros;
  for (int i = 0; i < 20; ++i) zeros.Add(0.0);
  EXPECT_EQ(zeros.Median().value, 0.0);
  EXPECT_EQ(zeros.RobustScale().value, 0.0);
  LogHistogram negative;
  for (int i = 0; i < 21; ++i) negative.Add(-5.0 + 0.1 * i);
  EXPECT_NEAR(negative.Median().value, -4.0, 0.03);
  LogHistogram huge;
  for (int i = 0; i < 20; ++i) huge.Add(65535.0);
  EXPECT_NEAR(huge.Median().value / 65535.0, 1.0, 0.006);
}

TEST(LogHistogram, HasTheRobustScaleOfItsSamples) {
  std::mt19937_64 random(8);
  // Samples around 0, and far from it: the scale is measured about the median.
  for (const double mean : {0.0, 0.2}) {
    std::vector<double> samples = Normals(random, 20000, mean, 0.01);
    LogHistogram histogram;
    for (const double sample : samples) histogram.Add(sample);
    const Estimate exact = RobustScale(samples);
    // Bins of 1 % about 0.2 are 2 mm wide.
    EXPECT_NEAR(histogram.RobustScale().value, exact.value, mean == 0.0 ? 1e-4 : 2e-3);
    EXPECT_EQ(histogram.RobustScale().num, 20000U);
  }
}

TEST(FitPowerLaw, RecoversAnExponentWithoutScatter) {
  std::vector<CurvePoint> points;
  for (double x = 5.0; x < 200.0; x *= 1.3) points.push_back({x, 40.0 * std::pow(x, -3.0), 0.05});
  const PowerLaw law = FitPowerLaw(points);
  EXPECT_NEAR(law.exponent.value, -3.0, 1e-9);
  EXPECT_NEAR(law.factor, 40.0, 1e-6);
  EXPECT_EQ(law.exponent.num, points.size());
}

TEST(FitPowerLaw, HoldsTheTruthAsOftenAsItSays) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  int hits = 0;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<CurvePoint> points;
    for (double x = 5.0; x < 200.0; x *= 1.3) {
      const double error = 0.02 + 0.001 * x;
      points.push_back({x, std::pow(x, -2.0) * std::exp(error * normal(random)), error});
    }
    hits += Holds(FitPowerLaw(points).exponent, -2.0) ? 1 : 0;
  }
  // The coverage may be higher, since the wider of two standard errors is taken.
  EXPECT_GE(hits, kLeastHits);
}

TEST(FitPowerLaw, PredictsWithAnIntervalThatHoldsTheTruth) {
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  int hits = 0;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<CurvePoint> points;
    for (double x = 5.0; x < 200.0; x *= 1.3) {
      points.push_back({x, 40.0 * std::pow(x, -2.0) * std::exp(0.05 * normal(random)), 0.05});
    }
    hits += Holds(FitPowerLaw(points).At(10.0), 0.4) ? 1 : 0;
  }
  EXPECT_GE(hits, kLeastHits);
  EXPECT_FALSE(FitPowerLaw({}).At(10.0).is_enough());
}

TEST(FitPowerLaw, TakesNoPartOfWhatHasNoLogarithm) {
  const PowerLaw law = FitPowerLaw({{1, 1, 0.1},
                                    {2, 0, 0.1},
                                    {kNaN, 4, 0.1},
                                    {4, 16, 0.1},
                                    {8, 64, 0.1},
                                    {16, 256, 0.1},
                                    {3, -1, 0.1},
                                    {0, 5, 0.1}});
  EXPECT_EQ(law.exponent.num, 4U);
  EXPECT_NEAR(law.exponent.value, 2.0, 1e-9);
  // All points have the same x, so no line can be fitted.
  EXPECT_FALSE(
      FitPowerLaw({{2, 1, 0.1}, {2, 2, 0.1}, {2, 3, 0.1}, {2, 4, 0.1}}).exponent.is_enough());
}

}  // namespace
}  // namespace railcast
