#include "generator/dataset/split_quota.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <vector>

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr auto kManyShares = std::to_array<PerPart<double>>({{0.7, 0.15, 0.15},
                                                             {0.8, 0.1, 0.1},
                                                             {0.64, 0.32, 0.04},
                                                             {0.78, 0.02, 0.2},
                                                             {0.5, 0.25, 0.25},
                                                             {0.9, 0.1, 0.0},
                                                             {1.0, 0.0, 0.0},
                                                             {0.0, 0.0, 1.0},
                                                             {1.0 / 3, 1.0 / 3, 1.0 / 3},
                                                             {0.98, 0.01, 0.01}});

TEST(SplitQuota, IsNearestToTheShares) {
  EXPECT_THAT(QuotaOf({0.7, 0.15, 0.15}, 20), ElementsAre(14, 3, 3));
  EXPECT_THAT(QuotaOf({0.7, 0.15, 0.15}, 24), ElementsAre(17, 4, 3));
  EXPECT_THAT(QuotaOf({0.8, 0.1, 0.1}, 12), ElementsAre(10, 1, 1));
  EXPECT_THAT(QuotaOf({0.1, 0.2, 0.7}, 10), ElementsAre(1, 2, 7));
  EXPECT_THAT(QuotaOf({0.8, 0.1, 0.1}, 1), ElementsAre(1, 0, 0));
  EXPECT_THAT(QuotaOf({0.98, 0.01, 0.01}, 10), ElementsAre(8, 1, 1));
}

TEST(SplitQuota, IsWithinLessThanOneScenarioOfEachShareWhereEachHasOne) {
  for (const PerPart<double>& shares : kManyShares) {
    for (std::uint32_t num = 100; num < 1000; ++num) {
      const PerPart<std::uint32_t> quota = QuotaOf(shares, num);
      EXPECT_EQ(std::accumulate(quota.begin(), quota.end(), 0U), num);
      for (std::size_t part = 0; part < kNumSplits; ++part) {
        EXPECT_LT(std::abs(quota[part] - shares[part] * num), 1.0) << num;
        EXPECT_EQ(quota[part] > 0, shares[part] > 0.0);
      }
    }
  }
}

TEST(SplitQuota, HoldsFiftyScenariosOrMoreWithinTwoPoints) {
  for (const PerPart<double>& shares : kManyShares) {
    for (std::uint32_t num = 50; num < 500; ++num) EXPECT_TRUE(HoldsShares(shares, num)) << num;
  }
}

TEST(SplitQuota, SaysWhichNumbersOfScenariosWouldHold) {
  EXPECT_EQ(QuotaFault({0.7, 0.15, 0.15}, 20), std::nullopt);
  EXPECT_EQ(QuotaFault({0.7, 0.15, 0.15}, 24),
            "must divide into train, val and test of 0.7, 0.15 and 0.15 within 0.02, as 21 and 25 "
            "do (got 24, at best divided into 17, 4 and 3)");
  EXPECT_THAT(QuotaFault({0.7, 0.15, 0.15}, 2).value(), HasSubstr("as 7 does (got 2, "));
  // A tenth of a point is not nothing.
  EXPECT_THAT(QuotaFault({0.998, 0.001, 0.001}, 20).value(), HasSubstr("(got 20, "));
}

TEST(Permuted, GivesEachPlaceOnce) {
  for (const std::uint64_t key : {std::uint64_t{0}, std::uint64_t{1}, ~std::uint64_t{0}}) {
    for (const std::uint32_t size : {1U, 2U, 3U, 4U, 5U, 12U, 16U, 17U, 63U, 64U, 65U, 1000U}) {
      std::vector<int> times(size, 0);
      for (std::uint32_t i = 0; i < size; ++i) ++times.at(Permuted(i, size, key));
      EXPECT_THAT(times, testing::Each(1)) << size;
    }
  }
}

TEST(Permuted, SpreadsNeighboursAsIfDrawnAtRandom) {
  // Of independent draws, the mean of n uniform numbers has a standard deviation of size/sqrt(12
  // n).
  constexpr std::uint32_t kSize = 100'000;
  constexpr std::uint32_t kNum = 1000;
  double sum = 0.0;
  for (std::uint32_t i = 0; i < kNum; ++i) sum += Permuted(i, kSize, 42);
  const double sigma = kSize / std::sqrt(12.0 * kNum);
  EXPECT_NEAR(sum / kNum, kSize / 2.0, 4.0 * sigma);
}

TEST(Permuted, ReachesTheEndOfTheLargestRecipes) {
  constexpr std::uint32_t kMost = 100'000'000;
  EXPECT_LT(Permuted(kMost - 1, kMost, 7), kMost);
  EXPECT_NE(Permuted(kMost - 1, kMost, 7), Permuted(kMost - 2, kMost, 7));
}

}  // namespace
}  // namespace railcast
