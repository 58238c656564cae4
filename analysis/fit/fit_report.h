#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/fit/fit.h"
#include "analysis/report/report.h"
#include "railcast/scenario.h"

namespace railcast {

/// Value of a fitted parameter in a scenario; NaN where the scenario has none.
[[nodiscard]] double ScenarioValue(const ScenarioSpec& scenario, const std::string& place);

/// The identified parameters only, as keys of a scenario ("lidar", "weather").
[[nodiscard]] std::string FittedJson(const FitResult& result);

/// Returns the scenario with the identified parameters replaced.
[[nodiscard]] ScenarioSpec FittedScenario(ScenarioSpec scenario, const FitResult& result);

/// Input of a fit's report.
struct FitReportInput {
  std::vector<std::string> sources;
  std::string kind;                      ///< RecordingInfo::kind of the first source.
  std::string command;                   ///< The command line as typed.
  std::optional<ScenarioSpec> scenario;  ///< Scenario that made the first source, if known.
};

[[nodiscard]] Report MakeFitReport(const FitReportInput& input,
                                   const RecordedTrials& trials,
                                   const FitSettings& settings,
                                   const FitResult& result);

}  // namespace railcast
