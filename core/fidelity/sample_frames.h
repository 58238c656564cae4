#pragma once

#include <cstdint>
#include <vector>

#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// Chooses frames that represent a scenario: the first one and further ones at a fixed spacing in
/// seconds. The spacing is halved until the vehicle is still on its track in the last one. The
/// frames depend only on the scenario, not on the part of its run that is being simulated.
/// @param simulator The simulator of the scenario.
[[nodiscard]] std::vector<std::uint32_t> SampleFrames(const ScenarioSpec& scenario,
                                                      const Simulator& simulator,
                                                      int num_frames,
                                                      double spacing_s);

}  // namespace railcast
