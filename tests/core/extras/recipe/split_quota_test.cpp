#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "core/extras/recipe/split_quota.h"

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

std::vector<SplitPlace> EqualPlaces(std::size_t num) {
  std::vector<SplitPlace> places;
  for (std::size_t i = 0; i < num; ++i) places.push_back({std::to_string(i), 1.0, {}});
  return places;
}

PerPart<double> WeightsOf(const std::vector<SplitPlace>& places, const std::vector<Split>& splits) {
  PerPart<double> weights{};
  for (std::size_t i = 0; i < places.size(); ++i) {
    weights.at(static_cast<std::size_t>(splits[i])) += places[i].weight;
  }
  return weights;
}

// A part is given a place only while it is owed something, so that it gets less than one place too
// much; what one part lacks, the two others have too much.
void ExpectIsNearShares(const std::vector<SplitPlace>& places,
                        const PerPart<double>& shares,
                        const KeyedDraws& draws) {
  const PerPart<double> weights = WeightsOf(places, DividePlaces(places, shares, draws).value());
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  double largest = 0.0;
  for (const SplitPlace& place : places) largest = std::max(largest, place.weight);
  for (std::size_t part = 0; part < kNumSplits; ++part) {
    EXPECT_LE(weights[part], shares[part] * sum + largest);
    EXPECT_GE(weights[part], shares[part] * sum - 2.0 * largest);
    EXPECT_EQ(weights[part] > 0.0, shares[part] > 0.0);
  }
}

TEST(SplitPlaces, ComeNearToTheSharesAndLeaveNoPartWithout) {
  constexpr auto kManyShares = std::to_array<PerPart<double>>({{0.7, 0.15, 0.15},
                                                               {0.64, 0.32, 0.04},
                                                               {0.78, 0.02, 0.2},
                                                               {0.5, 0.0, 0.5},
                                                               {0.98, 0.01, 0.01}});
  for (const PerPart<double>& shares : kManyShares) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const KeyedDraws draws(seed, 0);
      for (std::size_t num = 3; num < 60; num += 7) {
        std::vector<SplitPlace> places = EqualPlaces(num);
        ExpectIsNearShares(places, shares, draws);
        for (SplitPlace& place : places) place.weight = 0.1 + draws.Unit(place.name);
        ExpectIsNearShares(places, shares, draws);
      }
    }
  }
}

TEST(SplitPlaces, DoNotDependOnTheirOrder) {
  std::vector<SplitPlace> places = EqualPlaces(20);
  const PerPart<double> shares = {0.5, 0.25, 0.25};
  const auto by_name = [&] {
    const std::vector<Split> splits = DividePlaces(places, shares, {7, 0}).value();
    std::map<std::string, Split> named;
    for (std::size_t i = 0; i < places.size(); ++i) named[places[i].name] = splits[i];
    return named;
  };
  const auto before = by_name();
  std::ranges::reverse(places);
  EXPECT_EQ(by_name(), before);
}

TEST(SplitPlaces, AreDrawnAnewWithAnotherSeed) {
  const PerPart<double> shares = {0.5, 0.25, 0.25};
  EXPECT_NE(DividePlaces(EqualPlaces(20), shares, {7, 0}),
            DividePlaces(EqualPlaces(20), shares, {8, 0}));
}

TEST(SplitPlaces, KeepThePartsThatTheRecipeGives) {
  std::vector<SplitPlace> places = EqualPlaces(4);
  places[1].pinned = Split::kTest;
  places[2].pinned = Split::kTest;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto splits = DividePlaces(places, {0.5, 0.25, 0.25}, {seed, 0}).value();
    EXPECT_EQ(splits[1], Split::kTest);
    EXPECT_EQ(splits[2], Split::kTest);
    EXPECT_NE(splits[0], splits[3]);  // One is left for each of train and val.
  }
}

TEST(SplitPlaces, AreTooFewIfAPartGetsNone) {
  EXPECT_EQ(DividePlaces(EqualPlaces(2), {0.7, 0.15, 0.15}, {7, 0}), std::nullopt);
  EXPECT_EQ(DividePlaces({}, {1.0, 0.0, 0.0}, {7, 0}), std::nullopt);
  std::vector<SplitPlace> pinned = EqualPlaces(3);
  pinned[0].pinned = Split::kTrain;
  pinned[1].pinned = Split::kTrain;
  EXPECT_EQ(DividePlaces(pinned, {0.7, 0.15, 0.15}, {7, 0}), std::nullopt);
  EXPECT_NE(DividePlaces(pinned, {0.7, 0.3, 0.0}, {7, 0}), std::nullopt);
}

}  // namespace

}  // namespace railcast
