#include "core/detect/kernels/saturation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "core/detect/base/beam_optics.h"
#include "tests/core/detect/facing_beams.h"

namespace railcast {
namespace {

constexpr float kSaturation = 100.0F;

DetectorSpec Saturating() {
  DetectorSpec spec{.range_max_m = 1000.0, .effects = {.detection = true, .saturation = true}};
  spec.receiver.saturation_power_ratio = static_cast<double>(kSaturation);
  return spec;
}

// The power of an echo at R is (R_t / R)^2 of the threshold, with R_t = 447.2 m for 50 %.
TEST(Saturation, ClipsThePowerRatioAndNothingElse) {
  FacingBeams beams{.num_firings = kTileSize};
  beams.range_m = [](std::uint32_t firing) { return 5.0 + 1.7 * firing; };
  DetectorSpec spec = Saturating();
  const auto clipped = DetectFacing(spec, beams);
  spec.receiver.saturation_power_ratio.reset();
  const auto all = DetectFacing(spec, beams);
  const double threshold_m = 200.0 * std::sqrt(5.0);
  std::size_t num_clipped = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double ratio = std::pow(threshold_m / static_cast<double>(all[i].true_range_m), 2);
    const double expected = std::min(ratio, static_cast<double>(kSaturation));
    EXPECT_NEAR(static_cast<double>(clipped[i].power_ratio), expected, 1e-5 * expected);
    EXPECT_EQ(clipped[i].range_m, all[i].range_m);
    EXPECT_EQ(clipped[i].intensity, all[i].intensity);
    EXPECT_EQ(clipped[i].outcome, all[i].outcome);
    num_clipped += ratio > static_cast<double>(kSaturation) ? 1 : 0;
  }
  EXPECT_EQ(num_clipped, 24U) << "up to 44.7 m";
}

// At its ends a Gaussian pulse of peak p has fallen to 1.
TEST(Saturation, GivesTheLengthOverWhichAGaussianPulseIsAboveTheThreshold) {
  const auto tile = std::make_unique<DetectTile>();
  tile->num_rays = kTileSize;
  const auto sigma_m = static_cast<float>(PulseSigma_m(BeamSpec{}));
  for (std::size_t i = 0; i < kTileSize; ++i) {
    tile->power_ratio[i] = std::pow(1.08F, static_cast<float>(i) - 20.0F);
  }
  tile->power_ratio[7] = std::numeric_limits<float>::quiet_NaN();
  const auto power_ratio = std::make_unique<DetectTile>(*tile);
  AvailableKernels().back().saturation(*tile, {kSaturation, sigma_m});
  for (std::size_t i = 0; i < kTileSize; ++i) {
    const float ratio = power_ratio->power_ratio[i];
    if (!(ratio > 1.0F)) {
      EXPECT_EQ(tile->busy_m[i], 0.0F);
      continue;
    }
    const float z = tile->busy_m[i] / sigma_m;
    // The exponent is at most 19, of which float32 keeps 1e-6.
    EXPECT_NEAR(ratio * std::exp(-0.5F * z * z), 1.0F, 2e-5F) << ratio;
  }
  EXPECT_TRUE(std::isnan(tile->power_ratio[7]));
}

TEST(Saturation, ComesAfterRangeWalkAndBeforeRangeNoise) {
  FacingBeams beams{.num_firings = 1U << 14U};
  beams.range_m = [](std::uint32_t) { return 2.0; };  // Power ratio 50,000.
  DetectorSpec spec = Saturating();
  spec.effects.range_walk = spec.effects.range_noise = true;
  spec.receiver.range_walk_m = 10.0;
  spec.receiver.range_noise_floor_m = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for (const FacingEcho& echo : DetectFacing(spec, beams)) {
    const double error_m = static_cast<double>(echo.range_m) - 2.0;
    sum += error_m;
    squares += error_m * error_m;
  }
  const auto num = static_cast<double>(beams.num_firings);
  // The SNR is 5 at the threshold. The relative error of a variance is sqrt(2 / num).
  const double variance = 0.1 * 0.1 / (2.0 * 5.0 * static_cast<double>(kSaturation));
  EXPECT_NEAR(squares / num, variance, 4.0 * variance * std::sqrt(2.0 / num));
  EXPECT_NEAR(sum / num, 10.0 / 50'000.0, 4.0 * std::sqrt(variance / num));
}

}  // namespace
}  // namespace railcast
