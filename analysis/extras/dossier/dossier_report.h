#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "analysis/extras/study/finished_study.h"
#include "analysis/frontier/differences.h"
#include "analysis/report/report.h"
#include "railcast/scenario.h"

namespace railcast {

/// The words of dossiers (report/words.h).
extern const char* const kDossierWords;

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

/// An object in the way, as the study's rung and the rung `reference` see it on one approach, with
/// the same draws.
struct ComparedApproach {
  std::string target;
  Approach approach;
};

/// How far the rung of a study is from the reference on the study's own scenes.
struct ModelError {
  std::string rung;            ///< The study's rung; empty if its scenarios differ in their rungs.
  std::uint32_t min_points{};  ///< What the study's rule or detector asks for.
  std::vector<ComparedApproach> approaches;
};

/// Makes at most 40 frames of each approach of the sample on both rungs.
/// @param on_progress Called with the share that is done.
/// @throws InputError as MakeSimulator() does.
[[nodiscard]] ModelError MeasureModelError(const FinishedStudy& study,
                                           const std::vector<ScenarioSpec>& sample,
                                           int num_threads,
                                           const std::function<void(double done)>& on_progress);

/// Points against distance on both rungs, by target, and the distances from which on the points
/// suffice.
[[nodiscard]] Section ModelErrorSection(const ModelError& error);

/// What an assessor files of a study: question and verdict, scope, model with its error, sensor,
/// limits, sensitivity, comparison, the questions that rules ask, traceability, and lines to sign.
/// @param command Command line that made the report.
/// @throws InputError if no approach of the study comes to an object in the way.
[[nodiscard]] Report MakeDossier(const FinishedStudy& study,
                                 const std::vector<ScenarioSpec>& sample,
                                 const ModelError& error,
                                 const std::string& command);

/// A page whose drawings are in no colour of the text around, on which weasyprint 57 fails, with
/// marks of the same colours: each colour has definitions of its own.
[[nodiscard]] std::string WithColoredMarks(const std::string& html);

/// Prints a report's page with weasyprint.
/// @param page report.html as EmitReport() writes it.
/// @throws InputError if weasyprint is not found or fails, or if the file cannot be written.
void PrintPage(const std::filesystem::path& page, const std::filesystem::path& pdf);

}  // namespace railcast
