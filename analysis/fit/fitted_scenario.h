#pragma once

#include <string>

#include "analysis/fit/fit.h"
#include "analysis/fit/recorded_trials.h"
#include "core/scenario/scenario_spec.h"

namespace railcast {

/// A scenario's own value of a fitted parameter; NaN where it has none. Of the threshold: the range
/// at which it is 0.1.
[[nodiscard]] double ScenarioValue(const ScenarioSpec& scenario, const std::string& place);

/// A scenario's own reflectance of a material at the wavelength of its beam; NaN if it lacks it.
[[nodiscard]] double ScenarioReflectance(const ScenarioSpec& scenario, const std::string& material);

/// What was identified, and only that, as keys of a scenario ("lidar", "materials", "weather").
[[nodiscard]] std::string FittedJson(const FitSettings& settings,
                                     const RecordedTrials& trials,
                                     const FitResult& result);

/// The scenario with what was identified in place.
[[nodiscard]] ScenarioSpec FittedScenario(ScenarioSpec scenario,
                                          const FitSettings& settings,
                                          const RecordedTrials& trials,
                                          const FitResult& result);

}  // namespace railcast
