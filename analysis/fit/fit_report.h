#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/fit/fit.h"
#include "analysis/fit/recorded_trials.h"
#include "analysis/report/report.h"
#include "core/scenario/scenario_spec.h"

namespace railcast {

/// All that a fit's report is made of.
struct FitReportInput {
  std::vector<std::string> sources;
  std::string kind;                      ///< RecordingInfo::kind of the first.
  std::string command;                   ///< As typed.
  std::optional<ScenarioSpec> scenario;  ///< That the first was made by.
};

/// @param trials As FitModel left them.
[[nodiscard]] Report MakeFitReport(const FitReportInput& input,
                                   const RecordedTrials& trials,
                                   const FitSettings& settings,
                                   const FitResult& result);

}  // namespace railcast
