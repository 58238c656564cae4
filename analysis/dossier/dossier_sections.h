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

/// For each sensor of the sample whether it is a preset that was compared with recordings, and with
/// which result.
[[nodiscard]] Section SensorSection(const std::vector<ScenarioSpec>& sample);

/// What the sample's rungs do not model, and which way that errs.
/// @param has_detector Whether the study has one; otherwise points on objects are counted.
[[nodiscard]] Section LimitsSection(const std::vector<ScenarioSpec>& sample, bool has_detector);

/// The questions that rules on simulations ask, with their answers or as open.
[[nodiscard]] Section CredibilitySection();

/// Versions, hashes, seeds and the command that makes the study again.
[[nodiscard]] Section TraceabilitySection(const FinishedStudy& study);

/// Lines for those who sign.
[[nodiscard]] Section SignaturesSection();

}  // namespace railcast
