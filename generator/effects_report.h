#pragma once

#include <string>

#include "core/scenario/scenario_spec.h"

namespace railcast {

/// The rung and the effects that are on, in the order of scenario keys, with their parameters and
/// what these mean in the scenario's weather.
/// @throws InputError if effects do not go together.
[[nodiscard]] std::string EffectsText(const ScenarioSpec& scenario);

}  // namespace railcast
