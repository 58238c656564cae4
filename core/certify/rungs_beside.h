#pragma once

#include <optional>
#include <string>
#include <vector>

#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// A rung as it would be in a scenario.
struct RungBeside {
  std::string name;
  FiringVariant variant{};  ///< Without errors of ranges that are added after detection.
  double cost{};            ///< What a frame takes, in multiples of the run's own.
};

/// The effects of a rung in a scenario: with the scenario's own switches, as far as the rung can
/// have them.
[[nodiscard]] EffectSet EffectsAt(Fidelity rung, const ScenarioSpec& scenario);

/// What a frame takes for each of its firings on a rung, from the trace to the file, in the units
/// of InstructionsOf(). Rung `reference` takes what its sub-rays take.
[[nodiscard]] double InstructionsPerFiring(const EffectSet& effects, const BeamSpec& beam);

/// The dearest rung that takes less time than the run's own effects, and the cheapest one that
/// takes more, except `reference`: none, one or two.
[[nodiscard]] std::vector<RungBeside> RungsBeside(const ScenarioSpec& scenario,
                                                  const DetectorSpec& own);

}  // namespace railcast
