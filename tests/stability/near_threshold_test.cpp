#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "core/base/units.h"
#include "railcast/effects.h"
#include "railcast/simulator.h"
#include "tests/stability/regime.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/frame_checks.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

// Near the threshold small changes must have small consequences. With a hard threshold, a change of
// a millionth of the power makes a whole wall appear or vanish; with the noise of the receiver, the
// share of detected beams follows a smooth curve, and all rungs are on it.

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

// A retroreflector ten thousand times as bright as the dark wall that it hangs on.

constexpr std::uint16_t kDarkWall = 1;
constexpr std::uint16_t kBrightSheet = 2;
constexpr std::uint32_t kWallLabel = 1;
constexpr std::uint32_t kSheetLabel = 2;
constexpr double kSigma_rad = 0.75e-3;  // For a beam of 3 mrad.

MaterialLibrary RetroMaterials() {
  return MaterialLibrary({{.name = "dark", .reflectivity = 0.1},
                          {.name = "sheet", .reflectivity = 0.2, .retroreflectance = 1000.0}});
}

// A dark wall with a sheet in the same plane to the left of y = 0.
std::shared_ptr<SimpleWorld> SheetBesideWall(double range_m) {
  const auto x = static_cast<float>(range_m);
  const float h = 0.2F * x;
  return WorldOfParts({{{{{x, -h, -h}, {x, 0, -h}, {x, 0, h}, {x, -h, h}}, {{0, 1, 2}, {0, 2, 3}}},
                        kDarkWall,
                        kWallLabel},
                       {{{{x, 0, -h}, {x, h, -h}, {x, h, h}, {x, 0, h}}, {{0, 1, 2}, {0, 2, 3}}},
                        kBrightSheet,
                        kSheetLabel}});
}

enum class Rung { kSurface, kFootprint, kReference };
constexpr Rung kRungsOfPhysics[] = {Rung::kSurface, Rung::kFootprint, Rung::kReference};

SimulatorSpec Spec(Rung rung) {
  SimulatorSpec spec{.detector = {.range_max_m = 5000.0,
                                  .effects = {.surface_response = true,
                                              .pulse_stretch = true,
                                              .detection = true,
                                              .detection_probability = true,
                                              .range_noise = true,
                                              .footprint = rung != Rung::kSurface,
                                              .thin_conductors = rung == Rung::kFootprint,
                                              .dense_footprint = rung == Rung::kReference,
                                              .sampled_waveform = rung == Rung::kReference}}};
  spec.detector.beam.divergence_mrad = {3.0, 3.0};
  return spec;
}

Frame ScanAt(double range_m, const SimulatorSpec& spec) {
  return FrameBy(
      Simulator(SheetBesideWall(range_m), MakeRaster(2.0, 0.4, 0.02), RetroMaterials(), spec, 0));
}

double AzimuthOf_rad(const Frame& frame, std::size_t slot) {
  return RadFromDeg(1.0 - 0.02 * (frame.column[slot] + 0.5));
}

// The farthest of 256 sub-rays is 3.54 sigma off the axis.
TEST(Retroreflector, LeaksIntoNoBeamBeyondTheFootprint) {
  for (const Rung rung : kRungsOfPhysics) {
    const Frame frame = ScanAt(100.0, Spec(rung));
    std::size_t checked = 0;
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      const double off_rad = AzimuthOf_rad(frame, slot);
      if (off_rad > -3.6 * kSigma_rad) continue;
      ASSERT_EQ(frame.label[slot], kWallLabel);
      ASSERT_NEAR(static_cast<double>(frame.intensity[slot]),
                  0.1 * std::cos(static_cast<double>(frame.incidence_rad[slot])), 1e-4);
      ++checked;
    }
    EXPECT_GT(checked, 500U);
  }
}

TEST(Retroreflector, GivesABeamOnItsEdgeItsShareOfTheLight) {
  const Frame frame = ScanAt(100.0, Spec(Rung::kReference));
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const double off_rad = AzimuthOf_rad(frame, slot);
    if (std::abs(off_rad) > 2.0 * kSigma_rad) continue;
    const double share = 0.5 * std::erfc(-off_rad / kSigma_rad / std::sqrt(2.0));
    // An edge cuts some 16 of 256 cells, each of which may fall on either side: 4 sqrt(16 / 12).
    ASSERT_NEAR(static_cast<double>(frame.intensity[slot]), 1000.0 * share, 1000.0 * 5.0 / 256.0);
    ASSERT_EQ(frame.label[slot], kSheetLabel);
  }
}

TEST(Retroreflector, IsNeitherClampedNorInfinite) {
  RecordRegime("a retroreflector 10,000 times as bright as the wall behind",
               {"-", "intensity neither clamped nor infinite; no light in beams beyond 3.6 σ"});
  for (const Rung rung : kRungsOfPhysics) {
    for (const double range_m : {0.6, 10.0, 1000.0}) {
      const Frame frame = ScanAt(range_m, Spec(rung));
      ExpectSoundSlots(frame, 0.5F, 5000.0F);
      double most = 0.0;
      double highest_ratio = 0.0;
      for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
        ASSERT_TRUE(std::isfinite(frame.intensity[slot]) && std::isfinite(frame.power_ratio[slot]));
        most = std::max(most, static_cast<double>(frame.intensity[slot]));
        highest_ratio = std::max(highest_ratio, static_cast<double>(frame.power_ratio[slot]));
      }
      EXPECT_NEAR(most, 1000.2, 0.5);
      EXPECT_NEAR(highest_ratio / (1000.2 * 4e5 / (range_m * range_m)), 1.0, 0.005);
    }
  }
}

// The signal would suffice for 20 km; the gate ends at 5 km.
TEST(Retroreflector, IsSeenUpToTheRangeGate) {
  for (const Rung rung : kRungsOfPhysics) {
    SimulatorSpec spec = Spec(rung);
    spec.detector.effects.range_noise = false;
    const auto count = [&](double range_m) {
      const Frame frame = ScanAt(range_m, spec);
      return std::count(frame.outcome.begin(), frame.outcome.end(), Outcome::kReturned);
    };
    EXPECT_GT(count(4990.0), 900);
    EXPECT_EQ(count(5010.0), 0);
  }
}

// Measurements that noise moves beyond the gate are out of range: half of the beams on a sheet just
// at the gate.
TEST(Retroreflector, AtTheGateIsOutOfRangeHalfOfTheTime) {
  SimulatorSpec spec = Spec(Rung::kSurface);
  spec.detector.range_max_m = 100.01;
  const Frame frame = FrameBy(Simulator(SheetBesideWall(100.01 - 1e-3), MakeRaster(2.0, 0.4, 0.02),
                                        RetroMaterials(), spec, 0));
  double beyond = 0.0;
  double expected = 0.0;
  double variance = 0.0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (frame.label[slot] != kSheetLabel) continue;
    const double snr = 5.0 * static_cast<double>(frame.power_ratio[slot]);
    const double sigma_m = std::hypot(0.015, 0.1 / std::sqrt(2.0 * snr));
    const double rest_m = 100.01 - static_cast<double>(frame.true_range_m[slot]);
    const double p = 0.5 * std::erfc(rest_m / sigma_m / std::sqrt(2.0));
    expected += p;
    variance += p * (1.0 - p);
    beyond += frame.outcome[slot] == Outcome::kOutOfRange ? 1.0 : 0.0;
  }
  EXPECT_GT(expected, 100.0);
  EXPECT_NEAR(beyond, expected, 4.0 * std::sqrt(variance));
}

}  // namespace
}  // namespace railcast
