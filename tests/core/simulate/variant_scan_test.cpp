#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "railcast/scenario.h"
#include "railcast/simulator.h"
#include "tests/core/fidelity/line_scenario.h"
#include "tests/support/scan_once.h"

namespace railcast {
namespace {

TEST(VariantScan, MakesFiringsAsWholeFramesOfTheSameEffectsDo) {
  ScenarioSpec scenario = ReadLine({.trees_per_hectare = "100"});
  scenario.fidelity = Fidelity::kSurface;
  const auto simulator = MakeSimulator(scenario, 2);
  const EffectSet footprint = EffectsOfRung(Fidelity::kFootprint);
  const EffectSet own = simulator->spec().detector.effects;
  simulator->UseVariants({{own, 64}, {footprint, 64}});
  const ScanPattern& pattern = simulator->pattern();
  std::vector<std::uint32_t> cells;
  for (std::uint32_t cell = 5; cell < pattern.num_firings(); cell += 7) cells.push_back(cell);
  std::vector<Frame> frames(2);
  const auto begun = simulator->Begin(4);
  simulator->ScanFirings(*begun, cells, frames);
  const std::vector<EffectSet> effects = {own, footprint};
  for (std::size_t v = 0; v < 2; ++v) {
    SimulatorSpec spec = simulator->spec();
    spec.detector.effects = effects[v];
    simulator->Use(spec);
    const Frame whole = FrameBy(*simulator, 4);
    ASSERT_EQ(frames[v].rows, 1U);
    ASSERT_EQ(frames[v].columns, cells.size());
    ASSERT_EQ(frames[v].returns, whole.returns);
    std::size_t num_others = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::size_t few = i * whole.returns;
      const std::size_t slot = std::size_t{cells[i]} * whole.returns;
      // Rays are aimed within packets of others, which moves them by parts of 1e-7.
      const bool is_same = frames[v].label[few] == whole.label[slot] &&
                           frames[v].outcome[few] == whole.outcome[slot] &&
                           !(std::abs(frames[v].range_m[few] - whole.range_m[slot]) > 1e-3F);
      num_others += is_same ? 0 : 1;
    }
    EXPECT_LE(num_others, cells.size() / 100);
    EXPECT_GT(cells.size(), 300U);
  }
}

}  // namespace
}  // namespace railcast
