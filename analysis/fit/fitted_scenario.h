#pragma once

#include <string>

#include "analysis/fit/fit.h"
#include "railcast/scenario.h"

namespace railcast {

/// Value of a fitted parameter in a scenario; NaN where the scenario has none.
[[nodiscard]] double ScenarioValue(const ScenarioSpec& scenario, const std::string& place);

/// The identified parameters only, as keys of a scenario ("lidar", "weather").
[[nodiscard]] std::string FittedJson(const FitResult& result);

/// Returns the scenario with the identified parameters replaced.
[[nodiscard]] ScenarioSpec FittedScenario(ScenarioSpec scenario, const FitResult& result);

}  // namespace railcast
