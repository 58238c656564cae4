// The echoes of fog as the receiver sees them: power, ranges, neighbours.
#include "core/detect/kernels/fog_echo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/detect/base/beam_optics.h"
#include "core/detect/clutter/fog_profile.h"
#include "tests/core/detect/facing_beams.h"

namespace railcast {
namespace {

constexpr std::uint32_t kFog = 25;
constexpr std::uint32_t kFarthest = 1U << 15U;

DetectorSpec FogSpec(double visibility_m) {
  DetectorSpec spec{.seed = 5, .air_seed = 8, .range_min_m = 0.5, .effects = {.fog_echo = true}};
  spec.weather.visibility_m = visibility_m;
  spec.clutter_labels.fog = kFog;
  return spec;
}

DetectorSpec DetectedFog(double visibility_m) {
  DetectorSpec spec = FogSpec(visibility_m);
  spec.effects.detection = spec.effects.detection_probability = true;
  return spec;
}

// Packets of 16 beams that pass through patches of their own.
FacingBeams FarApart() {
  FacingBeams beams;
  beams.num_firings = kFarthest;
  beams.origin_y_m = [](std::uint32_t firing) { return 40.0F * static_cast<float>(firing / 16); };
  return beams;
}

double PeakRatio(const DetectorSpec& spec, double& range_m) {
  const FogProfile profile = FogProfileOf(spec);
  const auto peak = std::max_element(profile.ratio.begin(), profile.ratio.end());
  range_m = GateRange_m(profile, static_cast<std::size_t>(peak - profile.ratio.begin()));
  return static_cast<double>(*peak);
}

// Without noise and patches every beam has one echo: that of the profile's peak.
TEST(FogEcho, OfUniformFogWithoutNoiseIsThePeakOfTheProfile) {
  DetectorSpec spec = FogSpec(50.0);
  spec.receiver.snr_at_threshold = 100.0;
  spec.weather.fog_variation = 0.0;
  // A hundredth of the threshold does not hide which of two gates on the flat top is higher.
  double range_m = 0.0;
  const double ratio = PeakRatio(spec, range_m);
  FacingBeams beams;
  beams.num_firings = 1U << 12U;
  std::vector<double> ratios(beams.num_firings);
  for (const FacingEcho& echo : ClutterOf(DetectFacing(spec, beams))) {
    EXPECT_EQ(echo.clutter, kFog);
    EXPECT_EQ(echo.outcome, Outcome::kClutter);
    ratios[echo.firing] = std::max(ratios[echo.firing], static_cast<double>(echo.power_ratio));
    // The intensity is that before attenuation: power over P_min, range squared and loss.
    const double r = static_cast<double>(echo.true_range_m);
    const double loss = std::exp(-2.0 * std::log(20.0) / 50.0 * r);
    EXPECT_NEAR(static_cast<double>(echo.intensity) /
                    (static_cast<double>(echo.power_ratio) * 0.1 / 4e4 * r * r / loss),
                1.0, 1e-5);
  }
  for (const double seen : ratios) EXPECT_NEAR(seen / ratio, 1.0, 0.05);
}

// One noise decides: whatever of the waveform reaches the threshold is detected, as strong as the
// receiver measures it, and nothing is drawn anew.
TEST(FogEcho, IsDetectedWhereItsNoisyPowerReachesTheThreshold) {
  for (const ReturnMode mode : {ReturnMode::kStrongest, ReturnMode::kDual}) {
    DetectorSpec spec = FogSpec(100.0);
    spec.receiver.return_mode = mode;
    FacingBeams beams = FarApart();
    beams.range_m = [](std::uint32_t firing) { return firing % 3 == 0 ? 8.0 : 60.0; };
    std::vector<FacingEcho> expected = ClutterOf(DetectFacing(spec, beams));
    const std::size_t num_all = expected.size();
    std::erase_if(expected, [](const FacingEcho& echo) { return echo.power_ratio < 1.0F; });
    EXPECT_LT(expected.size(), num_all);
    spec.effects.detection = spec.effects.detection_probability = true;
    const std::vector<FacingEcho> detected = ClutterOf(DetectFacing(spec, beams));
    EXPECT_GT(detected.size(), 1000U);
    EXPECT_TRUE(detected == expected);
  }
}

// Without `detection_probability` the receiver has no noise: in uniform fog, all beams see the peak
// of the profile, or none does.
TEST(FogEcho, OfAReceiverWithoutNoiseIsSeenByAllBeamsOrByNone) {
  DetectorSpec spec = FogSpec(100.0);
  spec.effects.detection = true;
  spec.weather.fog_variation = 0.0;
  EXPECT_TRUE(ClutterOf(DetectFacing(spec, FarApart())).empty());
  spec.weather.visibility_m = 50.0;
  double range_m = 0.0;
  const double ratio = PeakRatio(spec, range_m);
  const auto fog = ClutterOf(DetectFacing(spec, FarApart()));
  ASSERT_EQ(fog.size(), kFarthest);
  for (const FacingEcho& echo : fog) {
    ASSERT_EQ(echo.outcome, Outcome::kClutter);
    // The vertex lies between gates 0.37 m apart on a peak that is metres wide.
    ASSERT_NEAR(static_cast<double>(echo.power_ratio) / ratio, 1.0, 1e-3);
    ASSERT_NEAR(static_cast<double>(echo.true_range_m), range_m, 0.19);
  }
}

// A window that lets half of the light through halves the fog's power, and not the noise.
TEST(FogEcho, IsWeakenedByTheWindowAsItsPowerIs) {
  DetectorSpec spec = FogSpec(50.0);
  spec.weather.fog_variation = 0.0;
  spec.receiver.snr_at_threshold = 1e9;
  const Detector clean(spec);
  spec.effects.cover = true;
  spec.cover.dirt_coverage = 0.1;
  const Detector dirty(spec);
  FacingBeams beams{.num_firings = kTileSize};
  EchoTiles echoes;
  const auto rays = std::make_unique<RayTile>();
  AimRays(beams, 0, *rays);
  float ratios[2];
  for (const bool is_dirty : {false, true}) {
    FillHits(beams, 0, echoes);
    std::fill_n(echoes.first.cover, kTileSize, 0.5F);
    const Detector& detector = is_dirty ? dirty : clean;
    detector.Respond(echoes.first);
    detector.Detect({*rays, Transform::Identity(), 0.0}, echoes);
    ASSERT_EQ(echoes.num_more(), kTileSize);
    const auto [tile, lane] = echoes.more(7);
    ratios[is_dirty ? 1 : 0] = tile.power_ratio[lane];
  }
  EXPECT_NEAR(ratios[1] / ratios[0], 0.5F, 1e-5F);
}

// Droplets fill metres of the beam, so that the noise decides where the peak is found.
TEST(FogEcho, ScattersOverMetresOfRange) {
  for (const double variation : {0.0, 0.2}) {
    DetectorSpec spec = DetectedFog(50.0);
    spec.weather.fog_variation = variation;
    double sum = 0.0;
    double squares = 0.0;
    double n = 0.0;
    for (const FacingEcho& echo : ClutterOf(DetectFacing(spec, FarApart()))) {
      if (echo.outcome != Outcome::kClutter) continue;
      const double r = static_cast<double>(echo.range_m);
      sum += r;
      squares += r * r;
      n += 1.0;
    }
    ASSERT_GT(n, 1000.0);
    const double sigma_m = std::sqrt(squares / n - sum / n * sum / n);
    EXPECT_GT(sigma_m, 1.0) << variation;
    EXPECT_LT(sigma_m, 4.0) << variation;
  }
}

TEST(FogEcho, EndsAPulseBeforeTheFirstSurface) {
  const DetectorSpec spec = FogSpec(50.0);
  FacingBeams beams = FarApart();
  beams.range_m = [](std::uint32_t firing) { return 0.2 * (firing % 50); };
  const double pulse_m = PulseLength_m(spec.beam);
  std::size_t count = 0;
  for (const FacingEcho& echo : ClutterOf(DetectFacing(spec, beams))) {
    ++count;
    EXPECT_LT(static_cast<double>(echo.true_range_m), 0.2 * (echo.firing % 50) - pulse_m + 1e-5);
    EXPECT_GE(static_cast<double>(echo.true_range_m), 0.5);
  }
  EXPECT_GT(count, 1000U);
}

// What is seen before a surface is what is seen there without it.
TEST(FogEcho, InFrontOfASurfaceIsThatOfAnEmptyBeam) {
  const DetectorSpec spec = FogSpec(50.0);
  FacingBeams beams = FarApart();
  const auto empty = ClutterOf(DetectFacing(spec, beams));
  beams.range_m = [](std::uint32_t) { return 60.0; };
  EXPECT_EQ(ClutterOf(DetectFacing(spec, beams)), empty);
}

TEST(FogEcho, ComesOnceFromABeamIfTheStrongestIsReported) {
  const auto fog = ClutterOf(DetectFacing(FogSpec(50.0), FarApart()));
  EXPECT_LE(fog.size(), kFarthest);
  DetectorSpec spec = FogSpec(50.0);
  spec.receiver.return_mode = ReturnMode::kLast;
  EXPECT_GT(ClutterOf(DetectFacing(spec, FarApart())).size(), fog.size());
}

TEST(FogEcho, MayComeTwiceFromOneBeamAtDifferentRanges) {
  DetectorSpec spec = DetectedFog(50.0);
  spec.receiver.return_mode = ReturnMode::kDual;
  std::vector<std::vector<double>> ranges_m(kFarthest);
  for (const FacingEcho& echo : ClutterOf(DetectFacing(spec, FarApart()))) {
    if (echo.outcome == Outcome::kClutter) {
      ranges_m[echo.firing].push_back(static_cast<double>(echo.true_range_m));
    }
  }
  std::size_t num_twice = 0;
  for (const auto& both : ranges_m) {
    ASSERT_LE(both.size(), 2U);
    if (both.size() < 2) continue;
    ++num_twice;
    EXPECT_GE(std::abs(both[0] - both[1]), PulseLength_m(spec.beam) * (1.0 - 1e-5));
  }
  EXPECT_GT(num_twice, kFarthest / 50);
}

// Correlation between whether the two beams of a pair, spacing_m apart, return fog: over 64 seeds
// of the patches, each with 1024 pairs 40 m apart.
double NeighbourCorrelation(float spacing_m) {
  constexpr std::uint32_t kNumPairs = 1024;
  constexpr std::uint64_t kNumAirSeeds = 64;
  double together = 0.0;
  double alone = 0.0;
  DetectorSpec spec = DetectedFog(150.0);
  FacingBeams beams;
  beams.num_firings = 32 * kNumPairs;
  beams.origin_y_m = [=](std::uint32_t firing) {
    const std::uint32_t packet = firing / 16;
    return 40.0F * static_cast<float>(packet / 2) + spacing_m * static_cast<float>(packet % 2);
  };
  for (spec.air_seed = 0; spec.air_seed < kNumAirSeeds; ++spec.air_seed) {
    std::vector<bool> is_seen(beams.num_firings);
    for (const FacingEcho& echo : ClutterOf(DetectFacing(spec, beams))) {
      if (echo.outcome == Outcome::kClutter) is_seen[echo.firing] = true;
    }
    for (std::uint32_t pair = 0; pair < kNumPairs; ++pair) {
      together += is_seen[32 * pair] && is_seen[32 * pair + 16] ? 1.0 : 0.0;
      alone += (is_seen[32 * pair] ? 1.0 : 0.0) + (is_seen[32 * pair + 16] ? 1.0 : 0.0);
    }
  }
  constexpr double kNum = kNumPairs * kNumAirSeeds;
  const double p = alone / (2.0 * kNum);
  return (together / kNum - p * p) / (p * (1.0 - p));
}

TEST(FogEcho, ComesInPatchesOfNeighbouringBeams) {
  // The correlation of 12 waves of one seed over 20 m is off by some 1 / sqrt(2 x 12) = 0.2; that
  // of 64 seeds by 0.026.
  constexpr double kStandardError = 0.026;
  const double same_place = NeighbourCorrelation(0.0F);
  EXPECT_GT(same_place, 0.15);
  EXPECT_NEAR(NeighbourCorrelation(0.05F), same_place, 4.0 * kStandardError);
  EXPECT_NEAR(NeighbourCorrelation(20.0F), 0.0, 4.0 * kStandardError);
}

TEST(FogEcho, OfTwoSensorsDiffersInItsNoiseAndSharesItsPatches) {
  DetectorSpec spec = FogSpec(50.0);
  const auto one = ClutterOf(DetectFacing(spec, FarApart()));
  spec.seed = 6;
  EXPECT_NE(ClutterOf(DetectFacing(spec, FarApart())), one);
  // Without noise only the patches decide, which both sensors see.
  spec.receiver.snr_at_threshold = 1e9;
  const auto still = ClutterOf(DetectFacing(spec, FarApart()));
  spec.seed = 5;
  const auto same = ClutterOf(DetectFacing(spec, FarApart()));
  ASSERT_EQ(same.size(), still.size());
  spec.air_seed = 9;
  EXPECT_NE(ClutterOf(DetectFacing(spec, FarApart())).front().power_ratio,
            same.front().power_ratio);
}

}  // namespace
}  // namespace railcast
