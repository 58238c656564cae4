#include "analysis/estimate/detection_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "analysis/estimate/estimate.h"
#include "analysis/estimate/logistic_model.h"

namespace railcast {
namespace {

constexpr double kFree = std::numeric_limits<double>::quiet_NaN();

/// A toxicity test with earthworms, of which about half stay in the earth where nothing is toxic:
/// dose, those that stayed, all. Data of N. Cedergreen in the R package drc; fitted in Ritz, Baty,
/// Streibig and Gerhard 2015, Dose-response analysis using R, PLOS ONE 10(12): e0146021, S1.
const std::vector<Inspection> kEarthworms = {
    {0, 3, 5},     {0, 3, 5},     {0, 3, 4},     {0, 5, 8},     {0, 4, 8},     {0.19, 4, 11},
    {0.19, 4, 9},  {0.19, 2, 8},  {0.19, 3, 8},  {0.19, 2, 4},  {0.38, 2, 9},  {0.38, 0, 4},
    {0.38, 6, 11}, {0.38, 4, 11}, {0.38, 4, 15}, {0.76, 0, 11}, {0.76, 1, 6},  {0.76, 1, 8},
    {0.76, 0, 9},  {0.76, 0, 8},  {1.53, 0, 6},  {1.53, 1, 10}, {1.53, 0, 10}, {1.53, 0, 10},
    {1.53, 0, 8},  {3.05, 0, 5},  {3.05, 0, 9},  {3.05, 0, 7},  {3.05, 0, 8},  {3.05, 1, 8},
    {6.11, 0, 3},  {6.11, 0, 7},  {6.11, 0, 11}, {6.11, 0, 10}, {6.11, 1, 7}};

TEST(DetectionCurve, AgreesWithAPublishedFitOfTheAsymptote) {
  const DetectionCurve curve = FitDetectionCurve(kEarthworms, kFree);
  EXPECT_NEAR(curve.slope, 1.505679, 3e-4);
  EXPECT_NEAR(curve.upper, 0.604929, 5e-5);
  EXPECT_NEAR(curve.middle_m, 0.292428, 5e-5);
}

TEST(DetectionCurve, AgreesWithAPublishedFitToAGivenAsymptote) {
  const DetectionCurve curve = FitDetectionCurve(kEarthworms, 0.5);
  EXPECT_NEAR(curve.slope, 1.646689, 3e-4);
  EXPECT_NEAR(curve.middle_m, 0.377269, 5e-5);
}

// Two shares determine two parameters.
TEST(DetectionCurve, GoesThroughTheSharesAtTwoRanges) {
  const DetectionCurve curve = FitDetectionCurve({{50.0, 9, 10}, {100.0, 2, 10}}, 1.0);
  EXPECT_NEAR(curve.At(50.0), 0.9, 1e-6);
  EXPECT_NEAR(curve.At(100.0), 0.2, 1e-6);
  EXPECT_NEAR(curve.slope, std::log(36.0) / std::log(2.0), 1e-5);
  EXPECT_NEAR(curve.RangeOf(0.9), 50.0, 1e-4);
  EXPECT_TRUE(std::isnan(DetectionCurve({0.8, 60.0, 5.0}).RangeOf(0.9)));
}

/// One target at each of so many ranges, evenly spaced in their logarithms.
std::vector<Inspection> DrawnFrom(const DetectionCurve& truth, int num, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform;
  std::vector<Inspection> inspections;
  for (int i = 0; i < num; ++i) {
    const double range_m = 20.0 * std::pow(10.0, (i + uniform(random)) / num);
    inspections.push_back({range_m, uniform(random) < truth.At(range_m) ? 1U : 0U, 1});
  }
  return inspections;
}

// The confidence is what it says: of many experiments, 95 % find a range that holds.
TEST(DetectionFit, FindsARangeThatHoldsIn95PercentOfAllExperiments) {
  const DetectionCurve truth{1.0, 90.0, 6.0};
  const double d90_m = truth.RangeOf(0.9);
  std::mt19937_64 random(1);
  constexpr int kNum = 300;
  int num_hold = 0;
  double sum_m = 0.0;
  for (int i = 0; i < kNum; ++i) {
    const DetectionFit fit = FitDetection(DrawnFrom(truth, 60, random));
    EXPECT_LE(fit.d90_95_m, fit.d90_m);
    num_hold += fit.d90_95_m <= d90_m ? 1 : 0;
    sum_m += fit.d90_m;
  }
  // Three standard errors. The plain maximum of the likelihood would hold in 0.91 of all.
  EXPECT_NEAR(static_cast<double>(num_hold) / kNum, 0.95, 3.0 * std::sqrt(0.95 * 0.05 / kNum));
  EXPECT_NEAR(sum_m / kNum, d90_m, 0.05 * d90_m);
}

// In fog, some near targets are missed. A curve that must reach 1 gets flatter for it, and says a
// shorter range than holds: as in the published case, where 28 becomes 42 (of a crack's size, for
// which more is worse; Annis, statistical-engineering.com/mh1823).
TEST(DetectionFit, FindsAnAsymptoteWhereNearTargetsAreMissed) {
  const DetectionCurve truth{0.95, 90.0, 12.0};
  std::mt19937_64 random(2);
  const std::vector<Inspection> inspections = DrawnFrom(truth, 2000, random);
  const DetectionFit fit = FitDetection(inspections);
  ASSERT_TRUE(fit.has_asymptote);
  EXPECT_NEAR(fit.curve.upper, 0.95, 0.02);
  EXPECT_LT(fit.upper_low, 0.95);
  EXPECT_GT(fit.upper_high, 0.95);
  EXPECT_NEAR(fit.d90_m, truth.RangeOf(0.9), 0.08 * fit.d90_m);
  EXPECT_LT(fit.d90_95_m, fit.d90_m);
  EXPECT_LT(FitDetectionCurve(inspections, 1.0).RangeOf(0.9), 0.85 * fit.d90_m);
}

TEST(DetectionFit, HasNoAsymptoteWithoutEvidence) {
  std::mt19937_64 random(3);
  const DetectionFit fit = FitDetection(DrawnFrom({1.0, 90.0, 6.0}, 200, random));
  EXPECT_FALSE(fit.has_asymptote);
  EXPECT_EQ(fit.curve.upper, 1.0);
}

TEST(DetectionFit, HasNoRangeWhereTheAsymptoteIsTooLow) {
  std::mt19937_64 random(4);
  const DetectionFit fit = FitDetection(DrawnFrom({0.7, 90.0, 8.0}, 400, random));
  ASSERT_TRUE(fit.has_asymptote);
  EXPECT_LT(fit.upper_high, 0.9);
  EXPECT_TRUE(std::isnan(fit.d90_m));
  EXPECT_TRUE(std::isnan(fit.d90_95_m));
}

// All targets up to 100 m are detected and none beyond: a step somewhere between, of which a
// plain likelihood would be certain.
TEST(DetectionFit, KnowsAStepToTheGapBetweenTargets) {
  std::vector<Inspection> inspections;
  for (int i = 0; i < 60; ++i) {
    const double range_m = 10.0 + 3.0 * i;
    inspections.push_back({range_m, range_m <= 100.0 ? 1U : 0U, 1});
  }
  const DetectionFit fit = FitDetection(inspections);
  EXPECT_GT(fit.d90_m, 90.0);
  EXPECT_LT(fit.d90_m, 104.0);
  EXPECT_GT(fit.d90_95_m, 75.0);
  EXPECT_LT(fit.d90_95_m, fit.d90_m);
}

// 0.9^29 = 0.047.
TEST(DetectionFit, TakesTwentyNineOfTwentyNineFor90With95Percent) {
  std::vector<Inspection> inspections;
  for (int i = 0; i < 28; ++i) inspections.push_back({100.0 + i, 1, 1});
  EXPECT_TRUE(std::isnan(FitDetection(inspections).d90_95_m));
  inspections.push_back({80.0, 1, 1});
  const DetectionFit fit = FitDetection(inspections);
  EXPECT_EQ(fit.d90_95_m, 80.0);
  EXPECT_TRUE(std::isnan(fit.d90_m));
}

TEST(DetectionFit, HasNoCurveWhereNothingIsDetected) {
  const DetectionFit fit = FitDetection({{50.0, 0, 40}, {100.0, 0, 40}});
  EXPECT_TRUE(std::isnan(fit.d90_m));
  EXPECT_TRUE(std::isnan(fit.d90_95_m));
  EXPECT_EQ(fit.num_targets, 80U);
}

// One group of each kind: the penalised estimate of a saturated table adds a half to each cell.
TEST(LogisticModel, OfTwoGroupsIsTheirLogOddsWithAHalfAddedToEachCount) {
  Eigen::MatrixXd x(30, 2);
  Eigen::VectorXd y(30);
  for (int i = 0; i < 30; ++i) {
    x(i, 0) = 1.0;
    x(i, 1) = i < 10 ? 0.0 : 1.0;
    y[i] = (i < 10 ? i < 3 : i < 25) ? 1.0 : 0.0;
  }
  const LogisticModel model = FitLogistic(x, y, {true, true});
  const double first = std::log(3.5 / 7.5);
  const double second = std::log(15.5 / 5.5);
  EXPECT_NEAR(model.coefficients[0], first, 1e-6);
  EXPECT_NEAR(model.coefficients[1], second - first, 1e-6);
}

TEST(LogisticModel, StaysFiniteWhereAColumnSeparatesTheOutcomes) {
  Eigen::MatrixXd x(20, 2);
  Eigen::VectorXd y(20);
  for (int i = 0; i < 20; ++i) {
    x(i, 0) = 1.0;
    x(i, 1) = i < 10 ? -1.0 : 1.0;
    y[i] = i < 10 ? 0.0 : 1.0;
  }
  const LogisticModel model = FitLogistic(x, y, {true, true});
  EXPECT_NEAR(model.coefficients[1], std::log(10.5 / 0.5), 1e-6);
}

TEST(LogisticModel, KeepsWhatIsNotFreeAtZero) {
  Eigen::MatrixXd x(8, 2);
  Eigen::VectorXd y(8);
  for (int i = 0; i < 8; ++i) {
    x(i, 0) = 1.0;
    x(i, 1) = i % 2 == 0 ? -1.0 : 1.0;
    y[i] = i < 6 ? 1.0 : 0.0;
  }
  const LogisticModel some = FitLogistic(x, y, {true, false});
  EXPECT_EQ(some.coefficients[1], 0.0);
  EXPECT_LE(some.log_likelihood, FitLogistic(x, y, {true, true}).log_likelihood + 1e-9);
}

TEST(LogisticModel, LeavesOutColumnsThatFollowFromOthers) {
  Eigen::MatrixXd x(4, 4);
  x << 1, 0, 1, 3,  //
      1, 1, 0, 1,   //
      1, 0, 1, 4,   //
      1, 1, 0, 1;
  EXPECT_EQ(IndependentColumns(x), (std::vector<std::size_t>{0, 1, 3}));
}

std::vector<double> OneTo(std::size_t num) {
  std::vector<double> values(num);
  std::iota(values.begin(), values.end(), 1.0);
  return values;
}

// The published ranks: 0.9^29 < 0.05, and so on (MIL-HDBK-1823A, "29 of 29", "45 of 46").
TEST(ToleranceLimit, HasThePublishedRanks) {
  EXPECT_TRUE(std::isnan(LimitsExceededBy90Percent(OneTo(28)).low));
  EXPECT_EQ(LimitsExceededBy90Percent(OneTo(29)).low, 1.0);
  EXPECT_EQ(LimitsExceededBy90Percent(OneTo(45)).low, 1.0);
  EXPECT_EQ(LimitsExceededBy90Percent(OneTo(46)).low, 2.0);
  EXPECT_EQ(LimitsExceededBy90Percent(OneTo(60)).low, 2.0);
  EXPECT_EQ(LimitsExceededBy90Percent(OneTo(61)).low, 3.0);
}

TEST(ToleranceLimit, HasNoneOfNoValues) {
  EXPECT_TRUE(std::isnan(LimitsExceededBy90Percent({}).low));
  EXPECT_TRUE(std::isnan(LimitsExceededBy90Percent({}).high));
  EXPECT_TRUE(std::isnan(LimitsExceededBy90Percent({7.0}).high));
  EXPECT_EQ(LimitsExceededBy90Percent({7.0, 8.0}).high, 8.0);
}

// By the definition of confidence. Of 2000 samples of 61, the share of wrong limits is that of the
// binomial distribution, at most 5 %, within four standard deviations.
TEST(ToleranceLimit, IsWrongInAtMostFiveOfAHundredSamples) {
  constexpr int kNumSamples = 2000;
  constexpr double kTruth = 0.1;  // What 90 % of uniform numbers exceed.
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform;
  int num_too_high = 0, num_too_low = 0;
  for (int i = 0; i < kNumSamples; ++i) {
    std::vector<double> values(61);
    for (double& value : values) value = uniform(random);
    const ToleranceLimits limits = LimitsExceededBy90Percent(values);
    num_too_high += limits.low > kTruth ? 1 : 0;
    num_too_low += limits.high < kTruth ? 1 : 0;
  }
  const double tolerance = 4.0 * std::sqrt(0.05 * 0.95 / kNumSamples);
  EXPECT_LE(num_too_high, (0.05 + tolerance) * kNumSamples);
  EXPECT_GE(num_too_high, 0.03 * kNumSamples);  // No idle width: P(Bin(61, 0.1) <= 2) = 0.0494.
  EXPECT_LE(num_too_low, (0.05 + tolerance) * kNumSamples);
}

}  // namespace
}  // namespace railcast
