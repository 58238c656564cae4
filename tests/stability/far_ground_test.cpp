#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/fidelity/frame_comparison.h"
#include "railcast/effects.h"
#include "tests/stability/regime.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/sensor_sector.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

// Far ground that fills a wide beam: where the echo's peak lies. The axis of the beam meets the
// ground behind it, since the near part of the beam is brighter and piles up. The yardstick is the
// rung `reference`, which adds up the pulses of 1,024 sub-rays.

constexpr double kHeight_m = 3.0;

class FarGroundOn : public testing::TestWithParam<std::string> {};

TEST_P(FarGroundOn, IsRangedWhereTheReferenceRangesIt) {
  const ScenarioSpec scenario = ReadMinimalWith(GetParam());
  const MaterialLibrary materials(scenario.materials);
  const auto world = WorldOfParts(
      {{MakeFloor(static_cast<float>(-kHeight_m), 600.0F), materials.Index("concrete"), 7}});
  const ScanPattern pattern = BuildScanPattern(CutSector(scenario.lidar.scan, {4.0, -4.0, -1.5}));
  SimulatorSpec spec = SpecOf(scenario.lidar, EffectsOfRung(Fidelity::kFootprint));
  spec.detector.effects.detection_probability = false;
  Simulator simulator(world, pattern, materials, spec, 0);
  const Frame rung = FrameBy(simulator);
  spec = SpecOf(scenario.lidar, YardstickEffects());
  spec.detector.effects.detection_probability = false;
  spec.detector.beam.reference_rays = 1024;
  simulator.Use(spec);
  const Frame reference = FrameBy(simulator);
  double num = 0.0;
  double sum_m = 0.0;
  double axis_m = 0.0;
  for (std::size_t slot = 0; slot < reference.num_slots(); ++slot) {
    const bool is_far = rung.true_range_m[slot] > 55.0F && rung.true_range_m[slot] < 85.0F;
    if (!is_far || !HasPoint(rung.outcome[slot]) || !HasPoint(reference.outcome[slot])) continue;
    num += 1.0;
    sum_m += static_cast<double>(rung.range_m[slot] - reference.range_m[slot]);
    axis_m += static_cast<double>(rung.true_range_m[slot] - reference.range_m[slot]);
  }
  ASSERT_GT(num, 50.0);
  RecordRegime("ground that fills a beam at 55 to 85 m",
               {"ranges the beam's axis: " + TwoDigits(1e3 * axis_m / num) + " mm too far",
                TwoDigits(1e3 * sum_m / num) + " mm", "the yardstick"});
  // The axis is off by this much, of which a peak drawn from 1,024 sub-rays tells 1.5 mm.
  EXPECT_GT(axis_m / num, 4e-3);
  EXPECT_NEAR(sum_m / num, 0.0, 1.5e-3);
}

INSTANTIATE_TEST_SUITE_P(FarSeeingSensors,
                         FarGroundOn,
                         testing::Values("vir2rail", "pandar64", "vls128"),
                         [](const auto& sensor) { return sensor.param; });

// Far away, through a narrow view of fine beams: 0.02 deg apart and 0.3 mrad wide, from 250 m to
// 2 km. Ranges keep their millimetre, and a pole of 0.2 m has as many points as in the reference.
// Simple methods fail: float32 in world coordinates, a slack that grows with the range, and rays
// that step over what is narrower than their spacing.

constexpr std::uint32_t kFarPole = 7;
constexpr std::uint32_t kFarWall = 8;
constexpr double kPoleRadius_m = 0.1;

// A grey target that fills a beam at `range_m` has 20 times the power that is needed. Sub-rays
// count in 64ths of a beam: were less than that enough, beams beside a target would be detected too
// often.
SimulatorSpec FarSpec(const EffectSet& effects, double range_m) {
  SimulatorSpec spec{.detector = {.range_max_m = 2500.0, .effects = WithoutRangeErrors(effects)}};
  spec.detector.effects.pointing_jitter = false;
  spec.detector.beam = {.divergence_mrad = {0.3, 0.3}, .reference_rays = 256};
  spec.detector.receiver.range_at_10_percent_m = 2.0 * range_m;
  return spec;
}

TEST(LongRange, RangesOfAWallKeepTheirMillimetre) {
  for (const float wall_m : {250.0F, 1000.0F, 2000.0F}) {
    const auto world = WorldOfParts({{MakeWall(wall_m, 100.0F), 2, kFarWall}});
    const ScanPattern pattern = MakeRaster(2.0, 0.4, 0.02);
    const Frame frame = ScanOnce(
        world, pattern, FarSpec(EffectsOfRung(Fidelity::kFootprint), static_cast<double>(wall_m)));
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      const std::size_t firing = std::size_t{frame.column[slot]} * pattern.rows + frame.ring[slot];
      const double expected_m = static_cast<double>(wall_m) / DirectionOf(pattern, firing).x();
      // float32 has steps of 0.12 mm at 2 km; the direction, the trace and the range round once.
      ASSERT_NEAR(static_cast<double>(frame.range_m[slot]), expected_m, 1e-3) << wall_m;
    }
  }
}

constexpr int kFarPoles = 6;
constexpr int kNumRows = 2;  // All rows meet an upright pole alike.
constexpr double kFineSpacing_deg = 0.02;

// All poles are moved aside together, by a share of the beams' spacing.
double PointsOnPoles(double range_m, const EffectSet& effects, double moved_beams) {
  auto world = std::make_shared<SimpleWorld>();
  // Every one elsewhere between the beams.
  for (int i = 0; i < kFarPoles; ++i) {
    Mesh pole = MakeCylinder(kPoleRadius_m, 20.0, 16);
    const double y_m =
        range_m * (0.0041 * (i - 2.5) + moved_beams * RadFromDeg(kFineSpacing_deg)) + 0.037 * i;
    for (auto& vertex : pole.vertices) {
      vertex += Eigen::Vector3f(static_cast<float>(range_m), static_cast<float>(y_m), 0.0F);
    }
    world->ground.parts.push_back({pole, 2, kFarPole});
  }
  const Frame frame =
      ScanOnce(world, MakeRaster(2.0, kNumRows * kFineSpacing_deg, kFineSpacing_deg),
               FarSpec(effects, range_m));
  double num = 0.0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    num += HasPoint(frame.outcome[slot]) && frame.label[slot] == kFarPole ? 1.0 : 0.0;
  }
  return num;
}

// Poles stand at ten places between two beams. A ray meets them with the probability that their
// width has in the spacing of beams, and so as often in the mean; in one arrangement it may meet
// none or each.
TEST(LongRange, APoleHasAsManyPointsAsInTheReference) {
  constexpr int kArrangements = 10;
  for (const double range_m : {250.0, 500.0, 1000.0}) {
    double expected = 0.0, found = 0.0, by_rays = 0.0;
    std::vector<double> shares;
    for (int i = 0; i < kArrangements; ++i) {
      const auto points = [&](const EffectSet& effects) {
        return PointsOnPoles(range_m, effects, (i + 0.5) / kArrangements);
      };
      const double yardstick = points(YardstickEffects());
      expected += yardstick;
      found += points(EffectsOfRung(Fidelity::kFootprint));
      const double rays = points(EffectsOfRung(Fidelity::kSurface));
      by_rays += rays;
      shares.push_back(100.0 * rays / yardstick);
    }
    ASSERT_GT(expected, 50.0) << range_m;
    EXPECT_NEAR(found / expected, 1.0, 0.05) << range_m << " m, of " << expected;
    // Of ten places a pole's edge passes one at most; 0.25 % of its width is lost to its 16 sides.
    const double rays_per_pole = 2.0 * kPoleRadius_m / range_m / RadFromDeg(kFineSpacing_deg);
    EXPECT_NEAR(by_rays / (kArrangements * kFarPoles * kNumRows), rays_per_pole,
                1.0 / kArrangements + 0.02 * rays_per_pole);
    const auto [least, most] = std::ranges::minmax(shares);
    RecordRegime(
        "poles of 20 cm at " + std::to_string(std::lround(range_m)) + " m, beams of 0.3 mrad",
        {TwoDigits(100.0 * by_rays / expected) + " % of the points; " + TwoDigits(least) + " to " +
             TwoDigits(most) + " % in ten arrangements",
         TwoDigits(100.0 * found / expected) + " % of the points", "the yardstick"});
  }
}

}  // namespace
}  // namespace railcast
