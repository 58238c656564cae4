#include "analysis/estimate/estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace railcast {
namespace {

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
