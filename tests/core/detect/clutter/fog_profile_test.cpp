// Compares the mean echo of fog with its closed forms and a slow integral (docs/physics.md 4.3).
#include "core/detect/clutter/fog_profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/detect/base/beam_optics.h"

namespace railcast {
namespace {

DetectorSpec SpecInFog(double visibility_m) {
  DetectorSpec spec;
  spec.weather.visibility_m = visibility_m;
  return spec;
}

// The soft-target integral in units of the least power, by the midpoint rule in steps of 0.1 mm.
double SlowRatio(double visibility_m, double near_range_m, double sigma_m, double range_m) {
  const double alpha = std::log(20.0) / visibility_m;
  constexpr double kStep_m = 1e-4;
  double sum = 0.0;
  for (double r = 0.5 * kStep_m; r < range_m + 8.0 * sigma_m; r += kStep_m) {
    const double z = (r - range_m) / sigma_m;
    const double gain = std::pow(r * r / (r * r + near_range_m * near_range_m), 2.0);
    sum += std::exp(-0.5 * z * z - 2.0 * alpha * r) * gain / (r * r) * kStep_m;
  }
  return std::numbers::pi * alpha / 65.0 * sum / (0.1 / 4e4);
}

TEST(FogProfile, IsTheSoftTargetIntegralConvolvedWithThePulse) {
  for (const double visibility_m : {20.0, 100.0, 1000.0}) {
    DetectorSpec spec = SpecInFog(visibility_m);
    for (const double pulse_ns : {1.0, 5.0, 20.0}) {
      spec.beam.pulse_length_ns = pulse_ns;
      for (const double r : {0.7, 3.0, 9.0, 25.0}) {
        const double slow = SlowRatio(visibility_m, 9.0, PulseSigma_m(spec.beam), r);
        // The sum leaves out what lies beyond five standard deviations: 6e-7 of a Gaussian, more
        // where the profile grows away from the vehicle, which 1e-4 allows for.
        EXPECT_NEAR(MeanFogRatio(spec, r) / slow, 1.0, 1e-4) << visibility_m << " " << r;
      }
    }
  }
}

// With a short pulse the echo is pi beta sqrt(2 pi) s g(r) e^(-2 alpha r) / r^2, whose derivative
// is 0 where alpha r^3 + r^2 + alpha n^2 r = n^2, n = near range.
TEST(FogProfile, OfAShortPulsePeaksAtTheRootOfItsCubic) {
  constexpr double kNear_m = 9.0;
  for (const double visibility_m : {20.0, 50.0, 200.0, 2000.0}) {
    DetectorSpec spec = SpecInFog(visibility_m);
    spec.beam.pulse_length_ns = 0.5;
    const double alpha = std::log(20.0) / visibility_m;
    double near_m = 0.0;
    double far_m = kNear_m;
    for (int i = 0; i < 60; ++i) {
      const double r = 0.5 * (near_m + far_m);
      const double cubic =
          alpha * r * r * r + r * r + alpha * kNear_m * kNear_m * r - kNear_m * kNear_m;
      (cubic < 0.0 ? near_m : far_m) = r;
    }
    const double sum = near_m * near_m + kNear_m * kNear_m;
    const double power = std::numbers::pi * alpha / 65.0 * std::sqrt(2.0 * std::numbers::pi) *
                         PulseSigma_m(spec.beam) * near_m * near_m / (sum * sum) *
                         std::exp(-2.0 * alpha * near_m) / (0.1 / 4e4);
    const double peak = MeanFogRatio(spec, near_m);
    // A pulse of s = 3 cm changes a peak that is metres wide by s^2 over its width squared.
    EXPECT_NEAR(peak / power, 1.0, 1e-3) << visibility_m;
    for (const double offset_m : {-0.3, 0.3}) {
      EXPECT_LT(MeanFogRatio(spec, near_m + offset_m), peak) << visibility_m;
    }
  }
}

// The table of docs/physics.md 4.3, which was computed apart from this code.
TEST(FogProfile, PeaksWhereThePublishedTableHasIt) {
  struct Row {
    double visibility_m;
    std::array<std::array<double, 2>, 3> peaks;  // Ratio and range for R0 50, 90, 200.
  };
  constexpr Row kTable[] = {
      {20, {{{3.81, 1.8}, {2.66, 2.7}, {1.18, 4.3}}}},
      {30, {{{3.06, 1.9}, {2.36, 3.0}, {1.26, 5.1}}}},
      {50, {{{2.15, 2.1}, {1.82, 3.4}, {1.18, 6.1}}}},
      {100, {{{1.22, 2.2}, {1.12, 3.7}, {0.88, 7.2}}}},
      {200, {{{0.653, 2.2}, {0.629, 3.9}, {0.552, 8.0}}}},
      {500, {{{0.272, 2.3}, {0.27, 4.0}, {0.256, 8.6}}}},
      {1000, {{{0.138, 2.3}, {0.138, 4.0}, {0.135, 8.8}}}},
      {2000, {{{0.0694, 2.3}, {0.07, 4.1}, {0.0693, 8.9}}}},
  };
  constexpr double kRanges_m[] = {50.0, 90.0, 200.0};
  for (const Row& row : kTable) {
    for (std::size_t k = 0; k < 3; ++k) {
      DetectorSpec spec = SpecInFog(row.visibility_m);
      spec.receiver.range_at_10_percent_m = kRanges_m[k];
      double best = 0.0;
      double best_m = 0.0;
      for (double r = 1.0; r < 11.0; r += 0.01) {
        const double ratio = MeanFogRatio(spec, r);
        if (ratio > best) best_m = r;
        best = std::max(best, ratio);
      }
      EXPECT_NEAR(best / row.peaks[k][0], 1.0, 0.006) << row.visibility_m;
      EXPECT_NEAR(best_m, row.peaks[k][1], 0.061) << row.visibility_m;
    }
  }
}

TEST(FogProfile, HasAQuarterOfTheGainAtTheNearRange) {
  DetectorSpec spec = SpecInFog(100.0);
  spec.beam.pulse_length_ns = 0.5;
  const double with = MeanFogRatio(spec, NearRange_m(spec.receiver));
  const double range_m = NearRange_m(spec.receiver);
  spec.receiver.near_range_m = 1e-3;
  // The gain changes within the pulse of 3 cm by less than 1 %.
  EXPECT_NEAR(with / MeanFogRatio(spec, range_m), 0.25, 1e-3);
}

TEST(FogProfile, NearRangeGrowsWithTheRangeOfTheDataSheetUnlessItIsGiven) {
  ReceiverSpec receiver;
  EXPECT_DOUBLE_EQ(NearRange_m(receiver), 9.0);
  receiver.range_at_10_percent_m = 50.0;
  EXPECT_DOUBLE_EQ(NearRange_m(receiver), 2.25);
  receiver.near_range_m = 4.0;
  EXPECT_EQ(NearRange_m(receiver), 4.0);
}

TEST(FogProfile, GrowsWithTheGainAndIsEmptyWithoutIt) {
  DetectorSpec spec = SpecInFog(100.0);
  const double once = MeanFogRatio(spec, 5.0);
  spec.receiver.fog_gain = 3.0;
  EXPECT_NEAR(MeanFogRatio(spec, 5.0) / once, 3.0, 1e-12);
  spec.receiver.fog_gain = 0.0;
  EXPECT_TRUE(FogProfileOf(spec).ratio.empty());
}

// Sensors from 10 to 500 m of range, in haze of 2 and 4 km: the densest patch stays below 0.2.
TEST(FogProfile, IsEmptyInHazeForSensorsOfAnyRange) {
  for (const double range_m : {10.0, 50.0, 90.0, 200.0, 220.0, 500.0}) {
    for (const double visibility_m : {2000.0, 4000.0, 1e6}) {
      DetectorSpec spec = SpecInFog(visibility_m);
      spec.receiver.range_at_10_percent_m = range_m;
      EXPECT_TRUE(FogProfileOf(spec).ratio.empty()) << range_m << " " << visibility_m;
    }
    DetectorSpec fog = SpecInFog(100.0);
    fog.receiver.range_at_10_percent_m = range_m;
    EXPECT_FALSE(FogProfileOf(fog).ratio.empty()) << range_m;
  }
  EXPECT_TRUE(FogProfileOf({}).ratio.empty());
}

TEST(FogProfile, HasItsGatesHalfAPulseApartUpToWhereTheDensestPatchFades) {
  const DetectorSpec spec = SpecInFog(50.0);
  const FogProfile profile = FogProfileOf(spec);
  EXPECT_DOUBLE_EQ(profile.gate_m, 0.5 * PulseLength_m(spec.beam));
  const double densest = DensestPatch(spec.weather);
  const double end_m = GateRange_m(profile, profile.ratio.size() - 1);
  EXPECT_LT(densest * MeanFogRatio(spec, end_m), kLeastFogRatio);
  EXPECT_GT(densest * MeanFogRatio(spec, end_m - 2.0 * profile.gate_m), kLeastFogRatio);
  EXPECT_LT(densest * MeanFogRatio(spec, GateRange_m(profile, 0)), kLeastFogRatio);
  EXPECT_GT(densest * MeanFogRatio(spec, GateRange_m(profile, 3)), kLeastFogRatio);
  for (std::size_t k = 0; k < profile.ratio.size(); ++k) {
    const double r = GateRange_m(profile, k);
    EXPECT_EQ(profile.ratio[k], static_cast<float>(MeanFogRatio(spec, r)));
  }
}

// Noise of variance 1 that correlates over a distance x by exp(-x^2 / 4 s^2).
TEST(FogProfile, HasNoiseAsLongAsThePulse) {
  const BeamSpec beam;
  const double half_m = 0.5 * PulseLength_m(beam);
  for (const double gate_m : {half_m, 1.3 * half_m, 2.0 * half_m, 8.0 * half_m}) {
    const FogNoiseWeights weights = FogNoiseOf(beam, gate_m);
    EXPECT_NEAR(weights.own * weights.own + 2.0 * weights.beside * weights.beside, 1.0, 1e-12);
    EXPECT_NEAR(2.0 * weights.own * weights.beside,
                std::exp(-0.25 * std::pow(gate_m / PulseSigma_m(beam), 2)), 1e-6);
  }
  EXPECT_NEAR(std::pow(FogNoiseOf(beam, half_m).beside, 2), 0.25, 1e-6);
}

TEST(FogProfile, NeverHasMoreGatesThanItMay) {
  for (const double pulse_ns : {0.5, 1.0, 5.0, 100.0}) {
    for (const double gain : {1.0, 10.0}) {
      for (const double visibility_m : {0.3, 10.0, 100.0, 1000.0}) {
        DetectorSpec spec = SpecInFog(visibility_m);
        spec.beam.pulse_length_ns = pulse_ns;
        spec.receiver.fog_gain = gain;
        spec.receiver.near_range_m = 0.1;
        EXPECT_LE(FogProfileOf(spec).ratio.size(), kMostFogGates);
      }
    }
  }
}

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
  const double n = kNumSeeds;
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
