// Measures what Embree's instruction set changes. The effects of railcast give the same bits on
// each; Embree's traversal orders its arithmetic by vector width, so that ranges differ in the last
// bits and a beam on an edge may fall on its other side.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "railcast/scenario.h"

namespace railcast {
namespace {

// Embree refuses instruction sets that the machine cannot run.
std::vector<std::string> InstructionSets() {
  std::vector<std::string> sets = {"sse4.2"};
  if (__builtin_cpu_supports("avx2")) sets.emplace_back("avx2");
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw")) {
    sets.emplace_back("avx512");
  }
  return sets;
}

TEST(InstructionSet, ChangesOnlyLastBitsAndBeamsOnEdges) {
  const ScenarioSpec spec = ReadScenario(std::filesystem::path(RAILCAST_SOURCE_DIR) /
                                         "scenarios/st_gallen_approach.json");
  const std::vector<std::string> sets = InstructionSets();
  if (sets.size() == 1) GTEST_SKIP() << "this machine runs only sse4.2";
  std::vector<Frame> frames(sets.size());
  for (std::size_t i = 0; i < sets.size(); ++i) MakeSimulator(spec, 0, sets[i])->Scan(0, frames[i]);
  const Frame& reference = frames.back();
  for (std::size_t i = 0; i + 1 < sets.size(); ++i) {
    std::size_t num_other_bits = 0;
    std::size_t num_other_surfaces = 0;
    double worst_m = 0.0;
    double farthest_m = 0.0;  // Between two surfaces.
    for (std::size_t slot = 0; slot < reference.num_slots(); ++slot) {
      const auto a = static_cast<double>(reference.true_range_m[slot]);
      const auto b = static_cast<double>(frames[i].true_range_m[slot]);
      if (a == b || (std::isnan(a) && std::isnan(b))) continue;
      ++num_other_bits;
      // The difference is larger than any rounding, so another triangle was hit.
      constexpr double kRounding_m = 2e-3;
      if (!(std::abs(a - b) <= kRounding_m)) {
        ++num_other_surfaces;
        farthest_m = std::max(farthest_m, std::abs(a - b));
      } else {
        worst_m = std::max(worst_m, std::abs(a - b));
      }
    }
    std::cout << sets[i] << " against " << sets.back() << ": " << num_other_bits << " of "
              << reference.num_slots() << " ranges differ, " << num_other_surfaces
              << " by another surface, up to " << farthest_m << " m, the rest by at most "
              << 1e3 * worst_m << " mm\n";
    EXPECT_LE(num_other_surfaces, 3U);
    EXPECT_LE(worst_m, 5e-4);
  }
}

}  // namespace
}  // namespace railcast
