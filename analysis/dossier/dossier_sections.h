#pragma once

#include <string>
#include <vector>

#include "analysis/report/report.h"
#include "analysis/study/finished_study.h"
#include "railcast/scenario.h"

namespace railcast {

// Sections of a dossier that say what a study covers and what it rests on.

/// What was drawn, and what was the same in all approaches, by the parts of an operational design
/// domain.
[[nodiscard]] Section ScopeSection(const FinishedStudy& study,
                                   const std::vector<ScenarioSpec>& sample);

/// The questions that rules on simulations ask, with their answers or as open.
[[nodiscard]] Section CredibilitySection();

/// Versions, hashes, seeds and the command that makes the study again.
[[nodiscard]] Section TraceabilitySection(const FinishedStudy& study);

/// Lines for those who sign.
[[nodiscard]] Section SignaturesSection();

}  // namespace railcast
