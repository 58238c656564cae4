// Far ground that fills a wide beam: where the echo's peak lies. The axis of the beam meets the
// ground behind it, since the near part of the beam is brighter and piles up. The yardstick is the
// rung `reference`, which adds up the pulses of 1,024 sub-rays.
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "core/fidelity/frame_comparison.h"
#include "tests/stability/regime.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/sensor_sector.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

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
  const Frame rung = ScanFrame(simulator);
  spec = SpecOf(scenario.lidar, YardstickEffects());
  spec.detector.effects.detection_probability = false;
  spec.detector.beam.reference_rays = 1024;
  simulator.Use(spec);
  const Frame reference = ScanFrame(simulator);
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

}  // namespace
}  // namespace railcast
