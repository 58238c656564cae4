#include "core/motion/markov_sequence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace railcast {
namespace {

constexpr int kNumSequences = 4000;
// Five standard deviations of a mean over that many independent numbers of variance 1, and of their
// mean square, whose variance is 2.
const double kMeanTolerance = 5.0 / std::sqrt(kNumSequences);
const double kSquareTolerance = 5.0 * std::sqrt(2.0 / kNumSequences);

/// Mean of f(seed) over independent seeds.
template <typename F>
double MeanOverSeeds(const F& f) {
  double sum = 0.0;
  for (std::uint64_t seed = 0; seed < kNumSequences; ++seed) sum += f(seed);
  return sum / kNumSequences;
}

double WalkAt(std::uint64_t seed, std::uint64_t index) {
  return MarkovSequence::Walk({seed, 1}).At(index);
}

TEST(WhiteNoise, IsStandardNormalAndIndependentFromOneElementToTheNext) {
  const auto noise = [](std::uint64_t index) { return WhiteNoise({5, 2}, index); };
  EXPECT_NEAR(MeanOverSeeds(noise), 0.0, kMeanTolerance);
  EXPECT_NEAR(MeanOverSeeds([&](std::uint64_t i) { return noise(i) * noise(i); }), 1.0,
              kSquareTolerance);
  EXPECT_NEAR(MeanOverSeeds([&](std::uint64_t i) { return noise(i) * noise(i + 1); }), 0.0,
              kMeanTolerance);
  // The normal distribution's share within one standard deviation, and its deviation.
  const double within = std::erf(std::sqrt(0.5));
  EXPECT_NEAR(MeanOverSeeds([&](std::uint64_t i) { return std::abs(noise(i)) < 1.0; }), within,
              5.0 * std::sqrt(within * (1.0 - within) / kNumSequences));
}

TEST(WhiteNoise, DiffersBetweenSeedsAndComponents) {
  EXPECT_NE(WhiteNoise({5, 2}, 7), WhiteNoise({6, 2}, 7));
  EXPECT_NE(WhiteNoise({5, 2}, 7), WhiteNoise({5, 3}, 7));
  EXPECT_NE(WhiteNoise({5, 2}, 7), WhiteNoise({5, 2}, 7 + (std::uint64_t{1} << 32U)));
}

TEST(MarkovSequence, AWalkBeginsAtZeroAndItsVarianceIsItsIndex) {
  EXPECT_EQ(WalkAt(3, 0), 0.0);
  for (const std::uint64_t index : {1U, 2U, 3U, 5U, 64U, 1000U, 65'537U}) {
    const double square = MeanOverSeeds([&](std::uint64_t seed) {
      const double at = WalkAt(seed, index);
      return at * at / static_cast<double>(index);
    });
    EXPECT_NEAR(square, 1.0, kSquareTolerance) << index;
  }
}

// Elements that are known from different halvings: their covariance is the lesser index.
TEST(MarkovSequence, AWalkHasTheCovarianceOfASum) {
  for (const auto& [i, j] : {std::pair{5U, 6U}, {7U, 9U}, {1000U, 1040U}, {1023U, 1025U}}) {
    const double covariance = MeanOverSeeds(
        [i = i, j = j](std::uint64_t seed) { return WalkAt(seed, i) * WalkAt(seed, j); });
    // The variance of the product of two normal numbers is at most twice that of either squared.
    EXPECT_NEAR(covariance, i, std::sqrt(static_cast<double>(i) * j) * kSquareTolerance) << i;
  }
}

TEST(MarkovSequence, TheStepsOfAWalkAreWhite) {
  const MarkovSequence walk = MarkovSequence::Walk({9, 0});
  const auto step = [&](std::uint64_t i) { return walk.At(2000 + i + 1) - walk.At(2000 + i); };
  EXPECT_NEAR(MeanOverSeeds(step), 0.0, kMeanTolerance);
  EXPECT_NEAR(MeanOverSeeds([&](std::uint64_t i) { return step(i) * step(i); }), 1.0,
              kSquareTolerance);
  for (const std::uint64_t lag : {1U, 2U, 8U}) {
    EXPECT_NEAR(MeanOverSeeds([&](std::uint64_t i) { return step(i) * step(i + lag); }), 0.0,
                kMeanTolerance);
  }
}

TEST(MarkovSequence, AStationaryOneHasVarianceOneAndForgetsExponentially) {
  constexpr double kDecay = 0.01;
  const auto at = [](std::uint64_t seed, std::uint64_t index) {
    return MarkovSequence::Stationary({seed, 2}, kDecay).At(index);
  };
  for (const std::uint64_t index : {0U, 1U, 5U, 1000U, 1'000'000U}) {
    const auto square = [&](std::uint64_t seed) { return at(seed, index) * at(seed, index); };
    EXPECT_NEAR(MeanOverSeeds(square), 1.0, kSquareTolerance) << index;
  }
  for (const auto& [i, j] : {std::pair{0U, 30U}, {1000U, 1001U}, {1000U, 1040U}, {1020U, 1170U}}) {
    const double product =
        MeanOverSeeds([&, i = i, j = j](std::uint64_t seed) { return at(seed, i) * at(seed, j); });
    EXPECT_NEAR(product, std::exp(-kDecay * (j - i)), kSquareTolerance) << i;
  }
}

TEST(MarkovSequence, IsFoundFarAwayAtOnce) {
  const double far = WalkAt(1, std::uint64_t{1} << 45U);
  EXPECT_TRUE(std::isfinite(far));
  EXPECT_LT(std::abs(far), 6.0 * std::exp2(22.5));
  EXPECT_TRUE(std::isfinite(MarkovSequence::Stationary({1, 0}, 1e-9).At((1ULL << 45U) + 12'345)));
}

}  // namespace
}  // namespace railcast
