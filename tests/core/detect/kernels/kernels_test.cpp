#include "core/detect/kernels/kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include "core/base/random.h"
#include "core/detect/clutter/fog_profile.h"
#include "core/detect/kernels/echo_power.h"
#include "core/detect/kernels/fog_echo.h"
#include "core/detect/kernels/measurement.h"
#include "core/detect/kernels/published.h"
#include "core/detect/kernels/surface_response.h"
#include "railcast/outcome.h"
#include "tests/support/recorded_bytes.h"

namespace railcast {
namespace {

std::unique_ptr<DetectTile> MixedTile() {
  auto tile = std::make_unique<DetectTile>();
  std::memset(static_cast<void*>(tile.get()), 0, sizeof(DetectTile));
  tile->num_rays = kTileSize;
  tile->frame = 12;
  for (std::uint32_t i = 0; i < kTileSize; ++i) {
    const auto words = RandomWords(99, RandomUse::kNoise, 0, i);
    const bool hit = i % 5 != 0;
    tile->firing[i] = 1000 + i;
    tile->direction_x[i] = 0.8F;
    tile->direction_y[i] = 0.6F;
    tile->true_range_m[i] =
        hit ? 300.0F * UnitFloat(words[0]) : std::numeric_limits<float>::quiet_NaN();
    tile->cos_incidence[i] = hit ? UnitFloat(words[1]) : std::numeric_limits<float>::quiet_NaN();
    tile->reflectivity[i] = hit ? UnitFloat(words[2]) : std::numeric_limits<float>::quiet_NaN();
    tile->outcome[i] = static_cast<std::uint32_t>(hit ? Outcome::kReturned : Outcome::kNoSurface);
  }
  return tile;
}

MeasurementParameters Measurement(float sigma0_m, float sigma1) {
  return {.seed = 7,
          .sigma0_m = sigma0_m,
          .sigma1 = sigma1,
          .range_min_m = 0.5F,
          .range_max_m = 280.0F};
}

void RunAll(const Kernels& kernels, DetectTile& tile) {
  const ThresholdParameters threshold{400'000.0F, 0.002F};
  kernels.hit(tile, 0.5F);
  kernels.threshold(tile, threshold);
  kernels.rain(tile, {7, 0.002F});
  kernels.snow(tile, {7, 0.3F, 8.0F, 0.5F, 0.02F, true, 24, threshold});
  kernels.sensor_dropout(tile, {7, 0.1F, 1e-3F, 0.2F, 30.0F});
  kernels.measure_isotropic(tile, Measurement(0.02F, 1e-4F));
}

TEST(Kernels, GiveTheSameBitsOnEveryInstructionSet) {
  const auto& all = AvailableKernels();
  const auto expected = MixedTile();
  RunAll(all.front(), *expected);
  RecordBytesOf("tile", *expected);
  for (const Kernels& kernels : all) {
    const auto tile = MixedTile();
    RunAll(kernels, *tile);
    // Compare bits, so that a NaN equals itself. The padding was set to zero with the tile.
    // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
    EXPECT_EQ(std::memcmp(tile.get(), expected.get(), sizeof(DetectTile)), 0) << kernels.isa;
  }
  if (all.size() == 1) GTEST_SKIP() << "this machine runs only the baseline instruction set";
}

// Rays of which some hit planes of various slopes and the others hit nothing.
std::unique_ptr<RayTile> MixedRays() {
  auto rays = std::make_unique<RayTile>();
  std::memset(static_cast<void*>(rays.get()), 0, sizeof(RayTile));
  rays->num_rays = kTileSize;
  for (std::uint32_t i = 0; i < kTileSize; ++i) {
    const auto words = RandomWords(98, RandomUse::kNoise, 0, i);
    const float azimuth_rad = UnitFloat(words[0]);
    const bool hit = i % 5 != 0;
    rays->direction_x[i] = 0.8F * std::cos(azimuth_rad);
    rays->direction_y[i] = 0.8F * std::sin(azimuth_rad);
    rays->direction_z[i] = i % 2 == 0 ? 0.6F : -0.6F;
    rays->range_m[i] = hit ? 300.0F * UnitFloat(words[1]) : 300.0F;
    rays->normal_x[i] = hit ? UnitFloat(words[1]) - 0.5F : 0.0F;
    rays->normal_y[i] = hit ? UnitFloat(words[2]) - 0.5F : 0.0F;
    rays->normal_z[i] = hit ? UnitFloat(words[3]) : 0.0F;
  }
  return rays;
}

// Cells on both sides of 0, and some lanes without a texture.
std::unique_ptr<TextureLanes> MixedTextures() {
  auto lanes = std::make_unique<TextureLanes>();
  for (std::uint32_t i = 0; i < kTileSize; ++i) {
    const auto words = RandomWords(96, RandomUse::kNoise, 0, i);
    lanes->x[i] = 2000.0F * (UnitFloat(words[0]) - 0.5F);
    lanes->y[i] = 2000.0F * (UnitFloat(words[1]) - 0.5F);
    lanes->z[i] = 2000.0F * (UnitFloat(words[2]) - 0.5F);
    lanes->base_x[i] = lanes->base_y[i] = lanes->base_z[i] = words[3];
    lanes->instance[i] = i % 3;
    lanes->variance[i] = i % 4 == 0 ? 0.0F : 0.1F;
  }
  return lanes;
}

// Runs every kernel of the physical rungs in order; returns the results that are not in the tiles.
std::vector<float> RunPhysics(const Kernels& kernels, RayTile& rays, DetectTile& tile) {
  BeamFrame beam{.sigma_h_rad = 7.5e-4F, .sigma_v_rad = 3.75e-4F};
  std::vector<float> values(kTileSize);
  kernels.pointing(rays, tile, beam, {7, 2e-4F});
  kernels.uniforms(tile, {7, RandomUse::kClutter, 200}, values.data());
  kernels.incidence(rays, tile);
  kernels.spread(rays, beam, tile);
  kernels.response(tile, {false, 400'000.0F, 0.3F, 0.9F, 0.1F});
  kernels.pulse_stretch(tile, {0.32F, true, true});
  const auto textures = MixedTextures();
  kernels.texture(tile, *textures, {7, 7.5e-4F, 3.75e-4F});
  kernels.extinction(tile, 0.004F);
  kernels.sunlight(tile, {2.0F});
  kernels.cover_loss(tile);
  kernels.detection(tile, {7, 5.0F});
  kernels.smooth_detection(tile, {7, 5.0F});
  kernels.blame_cover(tile);
  kernels.range_walk(tile, 0.2F);
  kernels.saturation(tile, {20.0F, 0.32F});
  kernels.intensity_noise(tile, {7, 0.1F});
  kernels.channel_gain(tile, {7, 0.2F});
  kernels.channel_gain_variation(tile, {7, 0.1F, 0.2F, 0.45F});
  kernels.hit(tile, 0.5F);
  const std::vector<float> fog_ratio(20, 1.0F);
  const auto peaks = std::make_unique<FogPeaks>();
  kernels.fog_peaks(
      {rays, tile, FogPatches(7).WavesAt(Transform::Identity(), 3.0)},
      {7, 2, 20, 0.75F, fog_ratio.data(), 0.3F, 0.14F, 0.1F, 0.2F, 0.5F, 0.75F, 2, 1.0F, false},
      *peaks);
  for (std::size_t e = 0; e < 2; ++e) {
    values.insert(values.end(), peaks->range_m[e], peaks->range_m[e] + kTileSize);
    values.insert(values.end(), peaks->ratio[e], peaks->ratio[e] + kTileSize);
  }
  MeasurementParameters measurement = Measurement(0.015F, 0.0F);
  const std::vector<float> bias_m(kTileSize, 0.01F);
  measurement.scale_m = 0.1F;
  measurement.snr_at_threshold = 5.0F;
  measurement.channel_bias_m = bias_m.data();
  kernels.measure_by_signal(tile, measurement);
  std::vector<float> range_m(rays.range_m, rays.range_m + 32);
  std::ranges::sort(range_m);
  const EchoWave wave{32, range_m.data(), tile.share, tile.specular_f0};
  WaveClimbs climbs{kTileSize / kClimbLanes, rays.range_m, tile.share, tile.specular_f0};
  for (std::size_t i = 0; i < kClimbLanes; ++i) climbs.from_m[i] = 30.0F * static_cast<float>(i);
  WavePeak peaks_of_waves[kClimbLanes];
  kernels.climb_waves(climbs, peaks_of_waves);
  for (const WavePeak& peak : peaks_of_waves)
    values.insert(values.end(), {peak.range_m, peak.value});
  values.resize(values.size() + 1000);
  kernels.sample_wave(wave, 0.0F, 0.3F, 1000, &values[values.size() - 1000]);
  return values;
}

// A mixed tile with the optics that the physical effects need in addition.
std::unique_ptr<DetectTile> MixedPhysicalTile() {
  auto tile = MixedTile();
  for (std::uint32_t i = 0; i < kTileSize; ++i) {
    const auto words = RandomWords(97, RandomUse::kNoise, 0, i);
    tile->channel[i] = i;
    tile->share[i] = UnitFloat(words[0]);
    tile->diffuse_a[i] = tile->reflectivity[i] * 0.8F;
    tile->diffuse_b[i] = tile->reflectivity[i] * 0.3F;
    tile->specular_f0[i] = UnitFloat(words[1]);
    tile->specular_alpha2[i] = UnitFloat(words[2]);
    tile->retro[i] = i % 7 == 0 ? 1000.0F : 0.0F;
    tile->peak_shift_m[i] = 0.1F * UnitFloat(words[3]);
    tile->cover[i] = i % 3 == 0 ? 1.0F : UnitFloat(words[3]);
  }
  return tile;
}

TEST(Kernels, OfPhysicsGiveTheSameBitsOnEveryInstructionSet) {
  const auto& all = AvailableKernels();
  const auto expected_rays = MixedRays();
  const auto expected = MixedPhysicalTile();
  const auto expected_values = RunPhysics(all.front(), *expected_rays, *expected);
  RecordBytesOf("rays", *expected_rays);
  RecordBytesOf("tile", *expected);
  RecordBytes("values", {reinterpret_cast<const char*>(expected_values.data()),
                         expected_values.size() * sizeof(float)});
  for (const Kernels& kernels : all) {
    const auto rays = MixedRays();
    const auto tile = MixedPhysicalTile();
    const auto values = RunPhysics(kernels, *rays, *tile);
    // NOLINTBEGIN(bugprone-suspicious-memory-comparison): as above.
    EXPECT_EQ(std::memcmp(rays.get(), expected_rays.get(), sizeof(RayTile)), 0) << kernels.isa;
    EXPECT_EQ(std::memcmp(tile.get(), expected.get(), sizeof(DetectTile)), 0) << kernels.isa;
    // NOLINTEND(bugprone-suspicious-memory-comparison)
    EXPECT_EQ(std::memcmp(values.data(), expected_values.data(), values.size() * sizeof(float)), 0)
        << kernels.isa;
  }
  if (all.size() == 1) GTEST_SKIP() << "this machine runs only the baseline instruction set";
}

TEST(Kernels, LeaveFiringsWithoutASurfaceWithoutAPoint) {
  const auto tile = MixedTile();
  AvailableKernels().back().measure_exact(*tile, Measurement(0.0F, 0.0F));
  for (std::size_t i = 0; i < kTileSize; i += 5) {
    EXPECT_EQ(tile->outcome[i], static_cast<std::uint32_t>(Outcome::kNoSurface));
    EXPECT_TRUE(std::isnan(tile->x[i]));
    EXPECT_TRUE(std::isnan(tile->range_m[i]));
  }
}

TEST(Kernels, SampleEachPartOfALongWaveAsIfItWereAlone) {
  // Three runs of components, 100 m apart, of which none reaches another.
  constexpr std::size_t kNum = 64;
  std::vector<float> range_m;
  std::vector<float> peak;
  std::vector<float> inverse;
  for (std::uint32_t i = 0; i < 3 * kNum; ++i) {
    const auto words = RandomWords(5, RandomUse::kNoise, 0, i);
    range_m.push_back(100.0F * static_cast<float>(i / kNum) + 5.0F * UnitFloat(words[0]));
    peak.push_back(UnitFloat(words[1]));
    inverse.push_back(5.0F + UnitFloat(words[2]));
  }
  std::ranges::sort(range_m);
  constexpr std::size_t kNumSamples = 1500;
  std::vector<float> all(kNumSamples);
  std::vector<float> one(kNumSamples);
  std::vector<float> sum(kNumSamples);
  for (const Kernels& kernels : AvailableKernels()) {
    std::ranges::fill(sum, 0.0F);
    for (std::size_t first = 0; first < 3 * kNum; first += kNum) {
      const EchoWave part{kNum, &range_m[first], &peak[first], &inverse[first]};
      kernels.sample_wave(part, -10.0F, 0.15F, kNumSamples, one.data());
      for (std::size_t k = 0; k < kNumSamples; ++k) sum[k] += one[k];
    }
    const EchoWave wave{3 * kNum, range_m.data(), peak.data(), inverse.data()};
    kernels.sample_wave(wave, -10.0F, 0.15F, kNumSamples, all.data());
    EXPECT_EQ(all, sum);
    EXPECT_GT(*std::ranges::max_element(all), 1.0F);
  }
}

}  // namespace
}  // namespace railcast
