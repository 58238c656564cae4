#include <gmock/gmock.h>
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

// How many of some firings have another first return than in a whole frame.
std::size_t NumOthers(const Frame& few,
                      const Frame& whole,
                      const std::vector<std::uint32_t>& cells) {
  std::size_t num_others = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t one = i * whole.returns;
    const std::size_t slot = std::size_t{cells[i]} * whole.returns;
    // Rays are aimed within packets of others, which moves them by parts of 1e-7.
    const bool is_same = few.label[one] == whole.label[slot] &&
                         few.outcome[one] == whole.outcome[slot] &&
                         !(std::abs(few.range_m[one] - whole.range_m[slot]) > 1e-3F);
    num_others += is_same ? 0 : 1;
  }
  return num_others;
}

std::vector<std::uint32_t> EverySeventhCell(const ScanPattern& pattern) {
  std::vector<std::uint32_t> cells;
  for (std::uint32_t cell = 5; cell < pattern.num_firings(); cell += 7) cells.push_back(cell);
  return cells;
}

TEST(VariantScan, TracesFullDetailWhereItIsAskedForAndTheFrameAsItIs) {
  ScenarioSpec scenario = ReadLine({.trees_per_hectare = "300"});
  scenario.fidelity = Fidelity::kSurface;
  const auto simulator = MakeSimulator(scenario, 2);
  scenario.world.detail = SceneDetail::kFull;
  const auto full = MakeSimulator(scenario, 2);
  const EffectSet effects = simulator->spec().detector.effects;
  const Frame before = FrameBy(*simulator, 4);
  simulator->UseVariants({{.effects = effects, .has_full_detail = true}, {.effects = effects}});
  const std::vector<std::uint32_t> cells = EverySeventhCell(simulator->pattern());
  // Frames need not be begun in order.
  for (const std::uint32_t index : {90U, 4U}) {
    std::vector<Frame> frames(2);
    const auto begun = simulator->Begin(index);
    simulator->ScanFirings(*begun, cells, frames);
    const Frame own = FrameBy(*simulator, index);
    const Frame fine = FrameBy(*full, index);
    EXPECT_LE(NumOthers(frames[0], fine, cells), cells.size() / 100) << index;
    EXPECT_LE(NumOthers(frames[1], own, cells), cells.size() / 100) << index;
    EXPECT_GT(NumOthers(frames[0], own, cells), cells.size() / 20) << index;
    if (index == before.index) {
      EXPECT_THAT(own.range_m, testing::Pointwise(testing::NanSensitiveFloatEq(), before.range_m));
    }
  }
}

TEST(VariantScan, MakesFiringsAsWholeFramesOfTheSameEffectsDo) {
  ScenarioSpec scenario = ReadLine({.trees_per_hectare = "100"});
  scenario.fidelity = Fidelity::kSurface;
  const auto simulator = MakeSimulator(scenario, 2);
  const EffectSet footprint = EffectsOfRung(Fidelity::kFootprint);
  const EffectSet own = simulator->spec().detector.effects;
  simulator->UseVariants({{own, 64}, {footprint, 64}});
  const std::vector<std::uint32_t> cells = EverySeventhCell(simulator->pattern());
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
    EXPECT_LE(NumOthers(frames[v], whole, cells), cells.size() / 100);
    EXPECT_GT(cells.size(), 300U);
  }
}

}  // namespace
}  // namespace railcast
