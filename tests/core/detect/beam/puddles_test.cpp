#include "core/detect/beam/puddles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace railcast {
namespace {

constexpr std::uint64_t kNumPuddleSeeds = 40'000;

bool IsWet(std::uint64_t seed, double share, float x_m, float y_m) {
  return IsUnderWater(Puddles(seed, share).WavesAt(Transform::Identity()), {x_m, y_m, -1.0F});
}

TEST(Puddles, CoverTheStatedShareOfTheGround) {
  for (const double share : {0.02, 0.1, 0.3, 0.5, 0.8}) {
    double wet = 0.0;
    for (std::uint64_t seed = 0; seed < kNumPuddleSeeds; ++seed) {
      wet += IsWet(seed, share, 31.0F, -8.0F) ? 1.0 : 0.0;
    }
    // Places of different seeds are independent. Of the Edgeworth series of 16 equal cosines, the
    // term of the kurtosis, 1.5 / 16 / 24 (q^3 - 3 q) phi(q), is at most 0.0022.
    const double sigma = std::sqrt(share * (1.0 - share) / static_cast<double>(kNumPuddleSeeds));
    EXPECT_NEAR(wet / static_cast<double>(kNumPuddleSeeds), share, 4.0 * sigma + 0.0022) << share;
  }
}

TEST(Puddles, CoverNothingOrEverythingAtTheEnds) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    EXPECT_FALSE(IsWet(seed, 0.0, 3.0F, 4.0F));
    EXPECT_TRUE(IsWet(seed, 1.0, 3.0F, 4.0F));
  }
}

// Two places are alike with the probability 1/2 + asin(r) / pi (the normal orthant probability),
// where the correlation r of waves in all directions of the plane is the mean of J0(2 pi d /
// wavelength).
TEST(Puddles, AreSomeMetresLong) {
  for (const double distance_m : {0.1, 0.5, 1.0, 3.0, 200.0}) {
    double correlation = 0.0;
    for (std::size_t i = 0; i < kNumPuddleWaves; ++i) {
      const double step = static_cast<double>(i) / static_cast<double>(kNumPuddleWaves - 1);
      const double wavelength_m =
          Puddles::kShortest_m * std::pow(Puddles::kLongest_m / Puddles::kShortest_m, step);
      correlation += std::cyl_bessel_j(0.0, 2.0 * std::numbers::pi * distance_m / wavelength_m) /
                     static_cast<double>(kNumPuddleWaves);
    }
    double alike = 0.0;
    for (std::uint64_t seed = 0; seed < kNumPuddleSeeds; ++seed) {
      const auto waves = Puddles(seed, 0.5).WavesAt(Transform::Identity());
      const float x_m = 5.0F + static_cast<float>(distance_m);
      alike += IsUnderWater(waves, {5.0F, 2.0F, 0.0F}) == IsUnderWater(waves, {x_m, 2.0F, 0.0F});
    }
    const double expected = 0.5 + std::asin(correlation) / std::numbers::pi;
    const double sigma =
        std::sqrt(expected * (1.0 - expected) / static_cast<double>(kNumPuddleSeeds));
    // The waves are not quite normal, which the first test bounds by 0.002 for a single place.
    EXPECT_NEAR(alike / static_cast<double>(kNumPuddleSeeds), expected, 4.0 * sigma + 0.005)
        << distance_m;
  }
}

TEST(Puddles, AreAtTheSamePlacesInAnyWindow) {
  const Puddles puddles(7, 0.3);
  const Transform world_from_here = MakeTransform(RotationFromYawPitchRoll(0.7, 0.0, 0.0),
                                                  Vector3(454'321.5, 5'234'567.25, 400.0));
  const Transform world_from_there = MakeTransform(RotationFromYawPitchRoll(-2.0, 0.0, 0.0),
                                                   Vector3(454'300.0, 5'234'500.0, 395.0));
  const PuddleWaves here = puddles.WavesAt(world_from_here);
  const PuddleWaves there = puddles.WavesAt(world_from_there);
  int num_wet = 0;
  int num_different = 0;
  for (int i = 0; i < 10'000; ++i) {
    const Vector3 place(0.3 * (i % 100), 0.3 * (i / 100), 0.1);
    const Eigen::Vector3f moved =
        (world_from_there.inverse() * (world_from_here * place)).cast<float>();
    const bool is_wet =
        IsUnderWater(here, {static_cast<float>(place.x()), static_cast<float>(place.y()), 0.1F});
    num_wet += is_wet ? 1 : 0;
    num_different += is_wet != IsUnderWater(there, {moved.x(), moved.y(), moved.z()}) ? 1 : 0;
  }
  EXPECT_GT(num_wet, 500);
  // Rounding moves the shores by some 10 micrometres of the cells' 0.3 m.
  EXPECT_LE(num_different, 1);
}

}  // namespace
}  // namespace railcast
