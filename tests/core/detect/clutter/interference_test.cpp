#include "core/detect/clutter/interference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/core/detect/facing_beams.h"

namespace railcast {
namespace {

DetectorSpec WithForeignPulses(double rate_hz) {
  DetectorSpec spec{.effects = {.detection = true, .interference = true}};
  spec.receiver.foreign_pulses_hz = rate_hz;
  spec.clutter_labels.false_alarm = 27;
  return spec;
}

// 299.5 m are 1.998 us: at 5000 pulses per second 1 - exp(-0.00999) of the firings.
TEST(Interference, ReachesTheShareOfFiringsThatListenWhenAPulseArrives) {
  const FacingBeams beams;
  const std::vector<FacingEcho> echoes = ClutterOf(DetectFacing(WithForeignPulses(5000.0), beams));
  const double n = beams.num_firings;
  const double p = -std::expm1(-5000.0 * 2.0 * 299.5 / 299'792'458.0);
  EXPECT_NEAR(p, 0.00994, 1e-5);
  EXPECT_NEAR(static_cast<double>(echoes.size()), n * p, 4.0 * std::sqrt(n * p));
  for (const FacingEcho& echo : echoes) {
    EXPECT_EQ(echo.outcome, Outcome::kClutter);
    EXPECT_EQ(echo.clutter, 27U);
  }
}

// The largest distance between the empirical distribution of values in [0, 1) and the uniform one.
double DistanceFromUniform(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double most = 0.0;
  const auto n = static_cast<double>(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto rank = static_cast<double>(i);
    most = std::max({most, std::abs(values[i] - rank / n), std::abs(values[i] - (rank + 1.0) / n)});
  }
  return most;
}

TEST(Interference, SpreadsEvenlyOverTheGateWithPowersThatFallAsTheInverse) {
  std::vector<double> places;
  std::vector<double> powers;
  for (const FacingEcho& echo : ClutterOf(DetectFacing(WithForeignPulses(50'000.0), {}))) {
    places.push_back((static_cast<double>(echo.range_m) - 0.5) / 299.5);
    powers.push_back(1.0 - 1.0 / static_cast<double>(echo.power_ratio));
  }
  // Kolmogorov and Smirnov's limit at one in a thousand.
  const double limit = 1.95 / std::sqrt(static_cast<double>(places.size()));
  EXPECT_LT(DistanceFromUniform(places), limit);
  EXPECT_LT(DistanceFromUniform(powers), limit);
}

// One pulse in five is stronger than 5 times the threshold.
TEST(Interference, IsClippedWhereTheReceiverSaturates) {
  DetectorSpec spec = WithForeignPulses(50'000.0);
  const std::vector<FacingEcho> bare = ClutterOf(DetectFacing(spec, {}));
  spec.effects.saturation = true;
  spec.receiver.saturation_power_ratio = 5.0;
  const std::vector<FacingEcho> clipped = ClutterOf(DetectFacing(spec, {}));
  ASSERT_EQ(clipped.size(), bare.size());
  std::size_t num_clipped = 0;
  for (std::size_t i = 0; i < bare.size(); ++i) {
    EXPECT_EQ(clipped[i].power_ratio, std::min(bare[i].power_ratio, 5.0F));
    EXPECT_EQ(clipped[i].range_m, bare[i].range_m);
    num_clipped += bare[i].power_ratio > 5.0F ? 1 : 0;
  }
  const auto n = static_cast<double>(bare.size());
  EXPECT_NEAR(static_cast<double>(num_clipped), 0.2 * n, 4.0 * std::sqrt(0.16 * n));
}

}  // namespace
}  // namespace railcast
