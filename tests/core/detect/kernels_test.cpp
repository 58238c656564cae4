#include "core/detect/kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "core/base/random.h"
#include "core/frame/outcome.h"

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
  kernels.sensor_dropout(tile, {7, 0.1F});
  kernels.measure_isotropic(tile, Measurement(0.02F, 1e-4F));
}

TEST(Kernels, GiveTheSameBitsOnEveryInstructionSet) {
  const auto& all = AvailableKernels();
  const auto expected = MixedTile();
  RunAll(all.front(), *expected);
  for (const Kernels& kernels : all) {
    const auto tile = MixedTile();
    RunAll(kernels, *tile);
    // Bits, so that a NaN equals itself; the padding was made zero with the tile.
    // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
    EXPECT_EQ(std::memcmp(tile.get(), expected.get(), sizeof(DetectTile)), 0) << kernels.isa;
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

}  // namespace
}  // namespace railcast
