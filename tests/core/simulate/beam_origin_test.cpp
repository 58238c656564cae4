// Beams that do not leave at the sensor's origin.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/base/units.h"
#include "railcast/simulator.h"
#include "tests/core/io/message_of.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr double kOut_m = 0.5;
constexpr double kUp_m = 0.25;

// One beam 10 deg beside the arm from whose end it leaves.
ScanPattern ArmPattern() {
  SpinningSpec spinning{.channels = {{.elevation_deg = 5.0, .azimuth_deg = 10.0, .time_us = 0.0}},
                        .cycle_us = 100.0,
                        .columns = 1000,
                        .beam_origin_m = {{kOut_m, kUp_m}}};
  return BuildScanPattern({.rate_hz = 10.0, .pattern = spinning});
}

TEST(BeamOrigin, OfATurningArmMovesRangesAndPoints) {
  // A wall across the forward direction.
  const auto world = WorldOfParts(
      {{{{{20, -60, -60}, {20, 60, -60}, {20, 60, 60}, {20, -60, 60}}, {{0, 1, 2}, {0, 2, 3}}},
        2,
        1}});
  const ScanPattern pattern = ArmPattern();
  const Frame frame = ScanOnce(world, pattern);
  int num_points = 0;
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const std::size_t slot = pattern.column[i];
    if (std::isnan(frame.x[slot])) continue;
    const double arm_rad = -2.0 * std::numbers::pi * pattern.column[i] / 1000.0;
    const Vector3 origin(kOut_m * std::cos(arm_rad), kOut_m * std::sin(arm_rad), kUp_m);
    const Vector3 direction = DirectionOf(pattern, i);
    const double range_m = (20.0 - origin.x()) / direction.x();
    const Vector3 point = origin + range_m * direction;
    // float32 resolves 100 m to 8 um.
    constexpr double kFloat_m = 5e-5;
    EXPECT_NEAR(static_cast<double>(frame.range_m[slot]), range_m, kFloat_m);
    EXPECT_NEAR(static_cast<double>(frame.x[slot]), point.x(), kFloat_m);
    EXPECT_NEAR(static_cast<double>(frame.y[slot]), point.y(), kFloat_m);
    EXPECT_NEAR(static_cast<double>(frame.z[slot]), point.z(), kFloat_m);
    ++num_points;
  }
  EXPECT_GT(num_points, 300);
}

TEST(BeamOrigin, BeyondAMetreIsRefused) {
  SpinningSpec spinning{.channels = {{}}, .cycle_us = 100.0, .columns = 10};
  spinning.beam_origin_m = {{0.0, 1.5}};
  EXPECT_EQ(MessageOf([&] {
              static_cast<void>(BuildScanPattern({.rate_hz = 10.0, .pattern = spinning}));
            }),
            "/pattern/beam_origin_m/1: must be >= -1 and <= 1 (got 1.5)");
}

}  // namespace
}  // namespace railcast
