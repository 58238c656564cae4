#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/extras/fit/fit.h"
#include "analysis/report/report.h"
#include "railcast/scenario.h"

namespace railcast {

/// The words of fits (report/words.h).
extern const char* const kFitWords;

/// Value of a fitted parameter in a scenario; NaN where the scenario has none.
[[nodiscard]] double ScenarioValue(const ScenarioSpec& scenario, const std::string& place);

/// The objects with fitted parameters, as keys of a scenario ("lidar", "weather"). They are whole,
/// since a scenario that builds on another one replaces its objects as wholes.
/// @param fitted FittedScenario().
[[nodiscard]] std::string FittedJson(const ScenarioSpec& fitted, const FitResult& result);

/// Returns the scenario with the identified parameters replaced that replays have not shown to be
/// worse.
[[nodiscard]] ScenarioSpec FittedScenario(ScenarioSpec scenario, const FitResult& result);

/// Input of a fit's report.
struct FitReportInput {
  std::vector<std::string> sources;
  std::string kind;     ///< RecordingInfo::kind of the first source.
  std::string command;  ///< The command line as typed.
  /// The scenario that is fitted: that which made the first source, or one that is given.
  std::optional<ScenarioSpec> scenario;
};

[[nodiscard]] Report MakeFitReport(const FitReportInput& input,
                                   const RecordedTrials& trials,
                                   const FitSettings& settings,
                                   const FitResult& result);

}  // namespace railcast
