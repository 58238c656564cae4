#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/fit/fit.h"
#include "analysis/report/report.h"
#include "railcast/scenario.h"

namespace railcast {

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
