#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/detect/facing_beams.h"

namespace railcast {
namespace {

// The power of an echo at R is (R_t / R)^2 of the threshold, with R_t = 447.2 m for 50 %.
TEST(RangeWalk, AddsTheInverseOfThePowerRatioUpToTheThreshold) {
  FacingBeams beams{.num_firings = kTileSize};
  beams.range_m = [](std::uint32_t firing) { return 5.0 + 1.7 * firing; };
  DetectorSpec spec{.range_max_m = 1000.0, .effects = {.detection = true, .range_walk = true}};
  spec.receiver.range_walk_m = 0.3;
  const double threshold_m = 200.0 * std::sqrt(5.0);
  for (const FacingEcho& echo : DetectFacing(spec, beams)) {
    if (echo.outcome != Outcome::kReturned) continue;
    const auto true_range_m = static_cast<double>(echo.true_range_m);
    const double error_m = static_cast<double>(echo.range_m) - true_range_m;
    // float32 has steps of 3e-5 m there.
    EXPECT_NEAR(error_m, 0.3 * std::pow(true_range_m / threshold_m, 2), 6e-5) << true_range_m;
  }
}

TEST(RangeWalk, IsNoMoreThanAtTheThresholdForEchoesThatNoiseLifts) {
  FacingBeams beams{.num_firings = 1U << 12U};
  beams.range_m = [](std::uint32_t) { return 470.0; };  // Power ratio 0.905.
  DetectorSpec spec{
      .range_max_m = 1000.0,
      .effects = {.detection = true, .detection_probability = true, .range_walk = true}};
  spec.receiver.range_walk_m = 0.3;
  std::size_t num = 0;
  for (const FacingEcho& echo : DetectFacing(spec, beams)) {
    if (echo.outcome != Outcome::kReturned) continue;
    EXPECT_NEAR(echo.range_m, 470.3F, 6e-5F);
    ++num;
  }
  EXPECT_GT(num, 500U);
}

}  // namespace
}  // namespace railcast
