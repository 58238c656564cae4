#pragma once

#include <string>

#include "analysis/dossier/model_error.h"
#include "analysis/report/report.h"
#include "analysis/study/finished_study.h"

namespace railcast {

/// What an assessor files of a study: question and verdict, scope, model with its error, sensor,
/// limits, sensitivity, comparison, the questions that rules ask, traceability, and lines to sign.
/// @param command Command line that made the report.
/// @throws InputError if no approach of the study comes to an object in the way.
[[nodiscard]] Report MakeDossier(const FinishedStudy& study,
                                 const std::vector<ScenarioSpec>& sample,
                                 const ModelError& error,
                                 const std::string& command);

}  // namespace railcast
