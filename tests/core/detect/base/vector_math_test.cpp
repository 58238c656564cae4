#include "core/detect/base/vector_math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/detect/base/lane_random.h"
#include "core/detect/base/normal_table.h"

namespace railcast {
namespace {

constexpr int kSteps = 2'000'000;

TEST(VectorMath, LogIsWithinTwoUlpOrOneTenMillionth) {
  double worst = 0.0;
  for (int i = 1; i <= kSteps; ++i) {
    const float x = static_cast<float>(i) / kSteps;
    const double truth = std::log(static_cast<double>(x));
    const double error = std::abs(static_cast<double>(baseline::Log(x)) - truth);
    worst = std::max(worst, error / std::max(1.0, std::abs(truth)));
  }
  EXPECT_LE(worst, 1e-7);
}

TEST(VectorMath, ExpIsWithinTwoUlp) {
  double worst = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const float x = -87.0F + 174.0F * static_cast<float>(i) / kSteps;
    const double truth = std::exp(static_cast<double>(x));
    worst = std::max(worst, std::abs(static_cast<double>(baseline::Exp(x)) - truth) / truth);
  }
  EXPECT_LE(worst, 2.0 * 0x1p-23);
  EXPECT_EQ(baseline::Exp(0.0F), 1.0F);
  EXPECT_LT(baseline::Exp(-1e6F), 1e-37F);
}

TEST(VectorMath, CosineAndSineOfATurnAreWithinTwoTenMillionths) {
  double worst = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const float u = static_cast<float>(i) / kSteps;
    float cosine{};
    float sine{};
    baseline::CosSinTurn(u, cosine, sine);
    const double angle_rad = 2.0 * std::numbers::pi * static_cast<double>(u);
    worst = std::max(worst, std::abs(static_cast<double>(cosine) - std::cos(angle_rad)));
    worst = std::max(worst, std::abs(static_cast<double>(sine) - std::sin(angle_rad)));
  }
  EXPECT_LE(worst, 2e-7);
}

TEST(VectorMath, TurnsHaveTheirFractionFromTheNearestWholeOne) {
  for (const float turns : {0.0F, 0.25F, -0.375F, 7.625F, -1000.125F, 4194302.5F}) {
    EXPECT_EQ(baseline::WithinHalfATurn(turns), std::remainder(turns, 1.0F)) << turns;
  }
}

TEST(VectorMath, AcosIsWithinHalfAMicroradian) {
  double worst = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const float x = static_cast<float>(i) / kSteps;
    const double error =
        std::abs(static_cast<double>(baseline::Acos(x)) - std::acos(static_cast<double>(x)));
    worst = std::max(worst, error);
  }
  EXPECT_LE(worst, 5e-7);
}

TEST(VectorMath, NormalCdfIsWithinFourTenMillionths) {
  double worst = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const float x = -20.0F + 30.0F * static_cast<float>(i) / kSteps;
    const double truth = 0.5 * std::erfc(-static_cast<double>(x) / std::numbers::sqrt2);
    worst = std::max(worst, std::abs(static_cast<double>(baseline::NormalCdf(x)) - truth));
  }
  EXPECT_LE(worst, 4e-7);
}

TEST(VectorMath, NormalCdfStaysWithinZeroAndOne) {
  for (const float x : {-1e6F, -40.0F, -6.0F, 0.0F, 6.0F, 40.0F, 1e6F}) {
    EXPECT_GE(baseline::NormalCdf(x), 0.0F) << x;
    EXPECT_LE(baseline::NormalCdf(x), 1.0F) << x;
  }
}

TEST(LaneWords, AreRandom123sBitForBit) {
  for (std::uint32_t firing = 0; firing < 1000; ++firing) {
    const std::uint64_t seed = 0x123456789ABCDEF0ULL + firing;
    const auto expected = RandomWords(seed, RandomUse::kNoise, 5, firing, 2);
    const auto words = baseline::LaneWords({seed, RandomUse::kNoise, 5}, firing, 2);
    ASSERT_EQ(words.a, expected[0]);
    ASSERT_EQ(words.b, expected[1]);
    ASSERT_EQ(words.c, expected[2]);
    ASSERT_EQ(words.d, expected[3]);
    ASSERT_EQ(baseline::LaneUnit(words.a), UnitFloat(expected[0]));
  }
}

TEST(LaneNormals, HaveTheMomentsOfANormalDistribution) {
  constexpr int kDraws = 250'000;
  double sum = 0.0;
  double sum2 = 0.0;
  double sum4 = 0.0;
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const auto n = baseline::LaneNormals(baseline::LaneWords({1, RandomUse::kNoise, 0}, i, 0));
    for (const float value : {n.a, n.b, n.c, n.d}) {
      const double v = static_cast<double>(value);
      sum += v;
      sum2 += v * v;
      sum4 += v * v * v * v;
    }
  }
  constexpr double kCount = 4.0 * kDraws;
  // Tolerances are five standard errors: the variances of v, v^2 and v^4 are 1, 2 and 96.
  EXPECT_NEAR(sum / kCount, 0.0, 5.0 / std::sqrt(kCount));
  EXPECT_NEAR(sum2 / kCount, 1.0, 5.0 * std::sqrt(2.0 / kCount));
  EXPECT_NEAR(sum4 / kCount, 3.0, 5.0 * std::sqrt(96.0 / kCount));
}

TEST(NormalTable, DensityAndShareAreThoseOfTheCLibrary) {
  const double scale = 1.0 / std::sqrt(2.0 * std::numbers::pi);
  for (int i = -70'000; i <= 70'000; ++i) {
    const double x = 1e-4 * i;
    EXPECT_NEAR(NormalDensity(x), scale * std::exp(-0.5 * x * x), x * x < 36.0 ? 1e-9 : 7e-9) << x;
    const double expected = 0.5 * std::erf(x / std::numbers::sqrt2) + 0.5;
    EXPECT_NEAR(NormalShare(-1e300, x), expected, 3e-9) << x;
  }
  EXPECT_EQ(NormalShare(-7.0, 7.0), 1.0);
}

}  // namespace
}  // namespace railcast
