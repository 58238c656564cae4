#include "core/extras/recipe/distribution.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

namespace railcast {
namespace {

using testing::AllOf;
using testing::Each;
using testing::Ge;
using testing::Le;

constexpr std::uint32_t kNumDraws = 4000;

std::vector<double> DrawMany(const Distribution& distribution) {
  std::vector<double> values;
  for (std::uint32_t i = 0; i < kNumDraws; ++i) {
    values.push_back(DrawValue(distribution, KeyedDraws(3, i), "value").get<double>());
  }
  return values;
}

double ShareBelow(const std::vector<double>& values, double limit) {
  const auto num = std::count_if(values.begin(), values.end(), [&](double v) { return v < limit; });
  return static_cast<double>(num) / static_cast<double>(values.size());
}

// Five standard deviations of a share, at its widest.
const double kTolerance = 5.0 * 0.5 / std::sqrt(double{kNumDraws});

TEST(Distribution, UniformFillsItsIntervalEvenly) {
  const std::vector<double> values = DrawMany(UniformDraw{-2.0, 6.0});
  EXPECT_THAT(values, Each(AllOf(Ge(-2.0), Le(6.0))));
  EXPECT_NEAR(ShareBelow(values, 0.0), 0.25, kTolerance);
  EXPECT_NEAR(ShareBelow(values, 4.0), 0.75, kTolerance);
}

TEST(Distribution, LogUniformGivesEachDecadeAsMuch) {
  const std::vector<double> values = DrawMany(LogUniformDraw{0.1, 100.0});
  EXPECT_THAT(values, Each(AllOf(Ge(0.1), Le(100.0))));
  EXPECT_NEAR(ShareBelow(values, 1.0), 1.0 / 3.0, kTolerance);
  EXPECT_NEAR(ShareBelow(values, 10.0), 2.0 / 3.0, kTolerance);
}

TEST(Distribution, NormalHasTheSharesOfItsStandardDeviations) {
  const std::vector<double> values = DrawMany(NormalDraw{10.0, 2.0, {}, {}});
  EXPECT_NEAR(ShareBelow(values, 10.0), 0.5, kTolerance);
  EXPECT_NEAR(ShareBelow(values, 8.0), 0.158655, kTolerance);
  EXPECT_NEAR(ShareBelow(values, 14.0), 0.977250, kTolerance);
}

TEST(Distribution, TruncatedNormalKeepsItsShapeBetweenTheBounds) {
  const std::vector<double> values = DrawMany(NormalDraw{0.0, 1.0, 0.0, 2.0});
  EXPECT_THAT(values, Each(AllOf(Ge(0.0), Le(2.0))));
  // Of the standard normal distribution from 0 to 1 and from 0 to 2.
  EXPECT_NEAR(ShareBelow(values, 1.0), 0.341345 / 0.477250, kTolerance);
}

TEST(Distribution, IntegersReachBothEndsEquallyOften) {
  std::map<std::int64_t, int> counts;
  for (std::uint32_t i = 0; i < kNumDraws; ++i) {
    const Json value = DrawValue(IntegerDraw{-1.0, 2.0}, KeyedDraws(3, i), "value");
    ASSERT_TRUE(value.is_number_integer());
    ++counts[value.get<std::int64_t>()];
  }
  ASSERT_EQ(counts.size(), 4U);
  EXPECT_EQ(counts.begin()->first, -1);
  for (const auto& [value, count] : counts)
    EXPECT_NEAR(count / double{kNumDraws}, 0.25, kTolerance);
}

TEST(Distribution, ChoiceFollowsItsWeights) {
  const ChoiceDraw choice{{{"a", "b", 3}}, {{1.0, 0.0, 3.0}}};
  int num_a = 0;
  for (std::uint32_t i = 0; i < kNumDraws; ++i) {
    const Json value = DrawValue(choice, KeyedDraws(3, i), "value");
    EXPECT_NE(value, "b");
    if (value == "a") ++num_a;
  }
  EXPECT_NEAR(num_a / double{kNumDraws}, 0.25, kTolerance);
}

TEST(Distribution, DrawsOfOneNameDifferByScenarioSeedAndTurnOnly) {
  const UniformDraw uniform{0.0, 1.0};
  const Json first = DrawValue(uniform, KeyedDraws(3, 7), "value");
  EXPECT_EQ(DrawValue(uniform, KeyedDraws(3, 7), "value"), first);
  EXPECT_NE(DrawValue(uniform, KeyedDraws(4, 7), "value"), first);
  EXPECT_NE(DrawValue(uniform, KeyedDraws(3, 8), "value"), first);
  EXPECT_NE(DrawValue(uniform, KeyedDraws(3, 7), "other"), first);
  EXPECT_NE(DrawValue(uniform, KeyedDraws(3, 7), "value", 1), first);
}

TEST(Distribution, NumbersHaveNineDigits) {
  const double value = DrawValue(UniformDraw{0.0, 1.0}, KeyedDraws(1, 1), "x").get<double>();
  constexpr double kDigits = 1e9;
  EXPECT_NEAR(value * kDigits, std::round(value * kDigits), 1e-6);
}

}  // namespace
}  // namespace railcast
