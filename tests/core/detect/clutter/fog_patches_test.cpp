#include "core/detect/clutter/fog_patches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace railcast {
namespace {

// The logarithm of the density in standard deviations, at a place of the window.
double FieldAt(const FogWaves& waves, const Vector3& place) {
  double sum = 0.0;
  for (std::size_t w = 0; w < kNumFogWaves; ++w) {
    const double turns =
        static_cast<double>(waves.x[w]) * place.x() + static_cast<double>(waves.y[w]) * place.y() +
        static_cast<double>(waves.z[w]) * place.z() + static_cast<double>(waves.phase[w]);
    sum += static_cast<double>(waves.amplitude[w]) * std::cos(2.0 * std::numbers::pi * turns);
  }
  return sum;
}

// Mean of sin(x) / x over the waves, which point in all directions alike.
double ExpectedCorrelation(double distance_m) {
  double sum = 0.0;
  for (std::size_t w = 0; w < kNumFogWaves; ++w) {
    const double x = 2.0 * std::numbers::pi * distance_m / FogPatches::Wavelength_m(w);
    sum += FogPatches::Variance(w) * std::sin(x) / x;
  }
  return sum;
}

constexpr std::uint64_t kNumSeeds = 40'000;

TEST(FogPatches, AreStandardNormalOverSeedsToTheFourthMoment) {
  double sum = 0.0;
  double squares = 0.0;
  double fourth = 0.0;
  for (std::uint64_t seed = 0; seed < kNumSeeds; ++seed) {
    const double g =
        FieldAt(FogPatches(seed).WavesAt(Transform::Identity(), 0.0), {3.0, -7.0, 1.0});
    sum += g;
    squares += g * g;
    fourth += g * g * g * g;
  }
  constexpr double n = kNumSeeds;
  EXPECT_NEAR(sum / n, 0.0, 4.0 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1.0, 4.0 * std::sqrt(2.0 / n));
  // A cosine of variance v has the fourth moment 3/2 v^2 instead of 3 v^2; the variance of g^4 is
  // below the normal distribution's 96.
  double expected = 3.0;
  for (std::size_t w = 0; w < kNumFogWaves; ++w) {
    expected -= 1.5 * FogPatches::Variance(w) * FogPatches::Variance(w);
  }
  EXPECT_NEAR(fourth / n, expected, 4.0 * std::sqrt(96.0 / n));
}

// Beams of neighbouring firings are centimetres apart at the ranges of fog, others are independent.
TEST(FogPatches, AreCorrelatedNearbyAndIndependentFarAway) {
  for (const double distance_m : {0.05, 0.5, 1.5, 5.0, 200.0}) {
    double product = 0.0;
    for (std::uint64_t seed = 0; seed < kNumSeeds; ++seed) {
      const FogWaves waves = FogPatches(seed).WavesAt(Transform::Identity(), 0.0);
      product += FieldAt(waves, {10.0, 2.0, 0.0}) * FieldAt(waves, {10.0, 2.0 + distance_m, 0.0});
    }
    EXPECT_NEAR(product / kNumSeeds, ExpectedCorrelation(distance_m),
                4.0 * std::sqrt(2.0 / kNumSeeds))
        << distance_m;
  }
  EXPECT_GT(ExpectedCorrelation(0.05), 0.999);
  EXPECT_LT(std::abs(ExpectedCorrelation(200.0)), 0.05);
}

// The density at one place of the world is the same wherever the window's origin and axes are.
TEST(FogPatches, StandInTheWorldWhateverTheWindow) {
  const FogPatches patches(7);
  const Transform world_from_window =
      MakeTransform(RotationFromYawPitchRoll(0.7, 0.1, -0.2), {2'700'000.0, 1'250'000.0, 450.0});
  const Transform world_from_other =
      MakeTransform(RotationFromYawPitchRoll(-1.1, 0.0, 0.3), {2'700'080.0, 1'249'950.0, 452.0});
  const FogWaves waves = patches.WavesAt(world_from_window, 20.0);
  const FogWaves others = patches.WavesAt(world_from_other, 20.0);
  for (int i = 0; i < 20; ++i) {
    const Vector3 place(1.3 * i, -2.1 * i, 0.4 * i);
    const Vector3 same = world_from_other.inverse() * (world_from_window * place);
    // float32 resolves a turn to 6e-8, over 100 m of 0.33 turns per metre to 4e-6 turns.
    EXPECT_NEAR(FieldAt(waves, place), FieldAt(others, same), 1e-3);
  }
}

TEST(FogPatches, MoveSlowly) {
  const FogPatches patches(7);
  const FogWaves now = patches.WavesAt(Transform::Identity(), 100.0);
  const FogWaves frame_later = patches.WavesAt(Transform::Identity(), 100.1);
  const FogWaves minute_later = patches.WavesAt(Transform::Identity(), 160.0);
  double greatest = 0.0;
  for (int i = 0; i < 100; ++i) {
    const Vector3 place(0.37 * i, 0.0, 0.0);
    // 0.1 s of wind of 0.6 m/s turn the shortest wave by 2 % and all by less: the sum of their
    // amplitudes, below sqrt(2 x 12) = 4.9, times 2 pi 0.02.
    EXPECT_NEAR(FieldAt(now, place), FieldAt(frame_later, place), 0.62);
    greatest = std::max(greatest, std::abs(FieldAt(now, place) - FieldAt(minute_later, place)));
    // The wind carries the patches along.
    const Vector3 carried = place + Vector3(0.5, 0.33, 0.0) * 60.0;
    EXPECT_NEAR(FieldAt(now, place), FieldAt(minute_later, carried), 1e-4);
  }
  EXPECT_GT(greatest, 1.0);
}

TEST(FogPatches, MoveWithTheWind) {
  const FogPatches patches(7, {-3.0, 8.0, 0.0});
  const FogWaves now = patches.WavesAt(Transform::Identity(), 100.0);
  const FogWaves later = patches.WavesAt(Transform::Identity(), 160.0);
  for (int i = 0; i < 100; ++i) {
    const Vector3 place(0.37 * i, 0.0, 0.0);
    EXPECT_NEAR(FieldAt(now, place), FieldAt(later, place + Vector3(-180.0, 480.0, 0.0)), 1e-3);
  }
}

TEST(FogPatches, OfOtherSeedsAreOthers) {
  const FogWaves a = FogPatches(1).WavesAt(Transform::Identity(), 0.0);
  const FogWaves b = FogPatches(2).WavesAt(Transform::Identity(), 0.0);
  EXPECT_NE(FieldAt(a, {1.0, 2.0, 3.0}), FieldAt(b, {1.0, 2.0, 3.0}));
}

}  // namespace
}  // namespace railcast
