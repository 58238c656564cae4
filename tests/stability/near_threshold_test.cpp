// Near the threshold small changes must have small consequences. With a hard threshold, a change of
// a millionth of the power makes a whole wall appear or vanish; with the noise of the receiver, the
// share of detected beams follows a smooth curve, and all rungs are on it.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "railcast/effects.h"
#include "tests/stability/regime.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr double kFacingWall_m = 100.0;
constexpr double kWallReflectance = 0.5;

double ShareBelow(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

/// A wall that faces the sensor, where the power is `ratio` times the threshold.
Frame ScanWall(double ratio, Fidelity rung, bool is_smooth) {
  const auto world = WorldOfParts({{MakeWall(static_cast<float>(kFacingWall_m), 20.0F), 2, 1}});
  SimulatorSpec spec{.detector = {.effects = {.surface_response = true,
                                              .detection = true,
                                              .detection_probability = is_smooth,
                                              .footprint = rung != Fidelity::kSurface,
                                              .dense_footprint = rung == Fidelity::kReference}}};
  spec.detector.beam.reference_rays = 32;
  // power ratio = rho / R^2 x R0^2 / 0.1
  spec.detector.receiver.range_at_10_percent_m =
      kFacingWall_m * std::sqrt(0.1 * ratio / kWallReflectance);
  return ScanOnce(world, MakeRaster(4.0, 4.0, 0.05), spec);
}

double NumDetected(const Frame& frame) {
  double num = 0.0;
  for (const Outcome outcome : frame.outcome) num += HasPoint(outcome) ? 1.0 : 0.0;
  return num;
}

TEST(NearThreshold, TheShareOfDetectedBeamsFollowsTheNoiseOnEveryRung) {
  constexpr double kSnr = 5.0;
  for (const Fidelity rung : {Fidelity::kSurface, Fidelity::kFootprint, Fidelity::kReference}) {
    for (const double ratio : {0.7, 0.9, 1.0, 1.1, 1.3}) {
      const Frame frame = ScanWall(ratio, rung, true);
      const auto num = static_cast<double>(frame.num_slots());
      const double expected = ShareBelow(kSnr * (ratio - 1.0));
      // Four standard deviations. At the wall's edge, 2 deg off, the power is 0.2 % less.
      const double tolerance = 4.0 * std::sqrt(expected * (1.0 - expected) / num) + 0.005;
      EXPECT_NEAR(NumDetected(frame) / num, expected, tolerance) << NameOf(rung) << ratio;
    }
  }
}

TEST(NearThreshold, AMillionthMoreOrLessChangesHardlyABeam) {
  for (const Fidelity rung : {Fidelity::kSurface, Fidelity::kFootprint}) {
    const Frame less = ScanWall(1.0 - 1e-6, rung, true);
    const Frame more = ScanWall(1.0 + 1e-6, rung, true);
    // Of 6,400 beams, 5 phi(0) x 2e-6 = 4e-6 each would change.
    EXPECT_LE(std::abs(NumDetected(more) - NumDetected(less)), 1.0) << NameOf(rung);
  }
}

TEST(NearThreshold, AHardThresholdLetsTheWholeWallAppear) {
  EXPECT_EQ(NumDetected(ScanWall(0.99, Fidelity::kSurface, false)), 0.0);
  const Frame above = ScanWall(1.01, Fidelity::kSurface, false);
  EXPECT_EQ(NumDetected(above), static_cast<double>(above.num_slots()));
  RecordRegime("a wall at the detection threshold",
               {"a hard threshold: 1 % more power, and the whole wall appears",
                "the detected share follows the receiver's noise on every rung"});
}

}  // namespace
}  // namespace railcast
