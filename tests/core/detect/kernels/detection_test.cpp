#include "core/detect/kernels/detection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

namespace railcast {
namespace {

constexpr std::uint32_t kNumDraws = 1U << 18U;
constexpr DetectionParameters kParameters{.seed = 11, .snr_at_threshold = 5.0F};

// Counts how many of kNumDraws firings with that power are detected.
template <bool kIsSmooth>
double CountDetected(float power_ratio) {
  auto tile = std::make_unique<DetectTile>();
  tile->num_rays = kTileSize;
  double count = 0.0;
  for (std::uint32_t begin = 0; begin < kNumDraws; begin += kTileSize) {
    for (std::uint32_t i = 0; i < kTileSize; ++i) {
      tile->firing[i] = begin + i;
      tile->power_ratio[i] = power_ratio;
      tile->outcome[i] = static_cast<std::uint32_t>(Outcome::kReturned);
    }
    baseline::ApplyDetection<kIsSmooth>(*tile, kParameters);
    for (std::size_t i = 0; i < kTileSize; ++i) {
      count += tile->outcome[i] == static_cast<std::uint32_t>(Outcome::kReturned) ? 1.0 : 0.0;
    }
  }
  return count;
}

TEST(Detection, ProbabilityIsThatOfNoiseOfTheAmplitudesOwnSize) {
  for (const double ratio : {0.5, 0.8, 1.0, 1.2, 1.5}) {
    const double p = 0.5 * std::erfc(-5.0 * (ratio - 1.0) / std::sqrt(2.0));
    EXPECT_NEAR(CountDetected<true>(static_cast<float>(ratio)), p * kNumDraws,
                4.0 * std::sqrt(p * (1.0 - p) * kNumDraws))
        << ratio;
  }
}

TEST(Detection, IsCertainFarAboveTheThresholdAndNeverHappensWithoutPower) {
  EXPECT_EQ(CountDetected<true>(1e30F), kNumDraws);
  EXPECT_EQ(CountDetected<true>(std::numeric_limits<float>::quiet_NaN()), 0.0);
  // Phi(-5) = 2.9e-7: one in three and a half million.
  EXPECT_LE(CountDetected<true>(0.0F), 1.0);
}

TEST(Detection, IsHardWithoutTheProbability) {
  EXPECT_EQ(CountDetected<false>(1.0F), kNumDraws);
  EXPECT_EQ(CountDetected<false>(std::nextafter(1.0F, 0.0F)), 0.0);
  EXPECT_EQ(CountDetected<false>(std::numeric_limits<float>::quiet_NaN()), 0.0);
}

TEST(Detection, LosesClutterTooAndLeavesOtherOutcomesAlone) {
  DetectTile tile{};
  const Outcome before[] = {Outcome::kClutter, Outcome::kEgo, Outcome::kNoSurface,
                            Outcome::kSensorDropout};
  tile.num_rays = 4;
  for (std::size_t i = 0; i < 4; ++i) tile.outcome[i] = static_cast<std::uint32_t>(before[i]);
  baseline::ApplyDetection<false>(tile, kParameters);
  EXPECT_EQ(static_cast<Outcome>(tile.outcome[0]), Outcome::kBelowThreshold);
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_EQ(static_cast<Outcome>(tile.outcome[i]), before[i]);
  }
}

TEST(Sunlight, RaisesTheThresholdByTheRootOfTheBackground) {
  DetectTile tile{};
  tile.num_rays = 2;
  tile.power_ratio[0] = tile.power_ratio[1] = 4.0F;
  tile.reflectivity[0] = 0.8F;
  tile.reflectivity[1] = 0.0F;  // A drop with no surface behind it.
  baseline::ApplySunlight(tile, {.background_gain = 3.0F});
  EXPECT_FLOAT_EQ(tile.power_ratio[0], 4.0F / std::sqrt(3.4F));
  EXPECT_EQ(tile.power_ratio[1], 4.0F);
}

}  // namespace
}  // namespace railcast
