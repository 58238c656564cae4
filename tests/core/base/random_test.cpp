#include "core/base/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "railcast/transform.h"

namespace railcast {
namespace {

TEST(RandomWords, DependOnEveryPartOfTheKey) {
  const auto base = RandomWords(1, RandomUse::kRain, 2, 3, 0);
  EXPECT_EQ(base, RandomWords(1, RandomUse::kRain, 2, 3, 0));
  EXPECT_NE(base, RandomWords(2, RandomUse::kRain, 2, 3, 0));
  EXPECT_NE(base, RandomWords(std::uint64_t{1} << 32U, RandomUse::kRain, 2, 3, 0));
  EXPECT_NE(base, RandomWords(1, RandomUse::kSnow, 2, 3, 0));
  EXPECT_NE(base, RandomWords(1, RandomUse::kRain, 3, 3, 0));
  EXPECT_NE(base, RandomWords(1, RandomUse::kRain, 2, 4, 0));
  EXPECT_NE(base, RandomWords(1, RandomUse::kRain, 2, 3, 1));
}

// Known-answer test published with Random123 (kat_vectors: philox4x32 10).
TEST(RandomWords, AgreeWithThePublishedVector) {
  const auto words = RandomWords(0, RandomUse{0}, 0, 0, 0);
  EXPECT_EQ(words[0], 0x6627e8d5U);
  EXPECT_EQ(words[1], 0xe169c58dU);
  EXPECT_EQ(words[2], 0xbc57ac4cU);
  EXPECT_EQ(words[3], 0x9b00dbd8U);
}

TEST(UnitFloat, IsUniformInTheHalfOpenUnitInterval) {
  EXPECT_EQ(UnitFloat(0U), 0.0F);
  EXPECT_LT(UnitFloat(0xFFFFFFFFU), 1.0F);
  constexpr int kDraws = 100000;
  double sum = 0.0;
  double sum_of_squares = 0.0;
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const double u = static_cast<double>(UnitFloat(RandomWords(7, RandomUse::kNoise, 0, i)[0]));
    sum += u;
    sum_of_squares += u * u;
  }
  // Tolerances are five standard errors of the mean (variance 1/12) and of the second moment
  // (variance 4/45).
  EXPECT_NEAR(sum / kDraws, 0.5, 5.0 * std::sqrt(1.0 / 12.0 / kDraws));
  EXPECT_NEAR(sum_of_squares / kDraws, 1.0 / 3.0, 5.0 * std::sqrt(4.0 / 45.0 / kDraws));
}

constexpr double kQuarterTurn_rad = std::numbers::pi / 2.0;

TEST(RotationFromYawPitchRoll, YawTurnsForwardToTheLeft) {
  const Vector3 turned = RotationFromYawPitchRoll(kQuarterTurn_rad, 0, 0) * Vector3::UnitX();
  EXPECT_TRUE(turned.isApprox(Vector3::UnitY(), 1e-12));
}

TEST(RotationFromYawPitchRoll, PositivePitchPointsTheNoseDown) {
  const Vector3 turned = RotationFromYawPitchRoll(0, 0.1, 0) * Vector3::UnitX();
  EXPECT_LT(turned.z(), 0.0);
}

TEST(RotationFromYawPitchRoll, PositiveRollRaisesTheLeftSide) {
  const Vector3 turned = RotationFromYawPitchRoll(0, 0, 0.1) * Vector3::UnitY();
  EXPECT_GT(turned.z(), 0.0);
}

}  // namespace
}  // namespace railcast
