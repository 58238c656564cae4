#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "core/simulate/scene_store.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// What scenarios of one process have in common, built once: lines, plants, chunks and Embree's
/// trees. The bytes of frames do not depend on it. Thread-safe.
struct SharedScenery {
  /// How many chunks are kept: 100 to 200 MB with their trees (docs/results/dataset_costs.md).
  static constexpr std::size_t kMostTriangles = 1'000'000;

  explicit SharedScenery(const std::string& isa_of_trace = {})
      : isa(isa_of_trace), stock(std::make_shared<TraceStock>(isa, kMostTriangles)) {}

  std::string isa;
  SharedLines lines;
  std::shared_ptr<TraceStock> stock;
};

/// MakeSimulators() of railcast/scenario.h with what earlier scenarios have built, on the
/// instruction set of `shared`.
[[nodiscard]] std::vector<std::unique_ptr<Simulator>> MakeSimulators(const ScenarioSpec& spec,
                                                                     int num_threads,
                                                                     SharedScenery& shared);

}  // namespace railcast
