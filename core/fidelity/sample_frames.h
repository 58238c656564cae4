#pragma once

#include <cstdint>
#include <vector>

#include "core/scenario/scenario_spec.h"
#include "core/simulate/simulator.h"

namespace railcast {

/// Frames that stand for a scenario: the first, and further ones so many seconds apart; nearer,
/// by halves, where the vehicle would leave its track before the last. They are a function of the
/// scenario, never of the part of its run that is being made.
/// @param simulator The scenario's.
[[nodiscard]] std::vector<std::uint32_t> SampleFrames(const ScenarioSpec& scenario,
                                                      const Simulator& simulator,
                                                      int num_frames,
                                                      double spacing_s);

}  // namespace railcast
