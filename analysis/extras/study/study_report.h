#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/estimate/detection_curve.h"
#include "analysis/extras/study/run_study.h"
#include "analysis/extras/study/study_factors.h"
#include "analysis/extras/study/study_spec.h"
#include "analysis/report/report.h"
#include "core/certify/certified_figures.h"

namespace railcast {

/// The words of studies (report/words.h).
extern const char* const kStudyWords;

class ProgramOptions;

/// What a study knows of one target: of a kind of object in the way, over all approaches.
struct TargetResult {
  std::string name{};
  std::string type{};  ///< Type of its first object.
  ObservedGroup seen{};
  double least_distance_m = std::numeric_limits<double>::quiet_NaN();  ///< Least of a detection.
  /// Where 90 % are detected, with a confidence of 95 %; NaN with fewer approaches than a fit
  /// takes, or where so many detect nothing that no distance has that confidence.
  double d90_95_m = std::numeric_limits<double>::quiet_NaN();
  DetectionFit fit{};  ///< Fit of its distances; all NaN with fewer inspections than it takes.

  [[nodiscard]] bool has_fit() const { return seen.num >= DetectionFit::kMinTargets; }
};

/// By name.
[[nodiscard]] std::vector<TargetResult> TargetsOf(const std::vector<Observation>& observations);

/// Whether objects are detected in time: "yes", "no", "not shown", or why that is not known.
[[nodiscard]] Judgement AnswerOf(const ObservedGroup& seen);

/// For each target the answer, d90/95 and the greatest distance needed.
[[nodiscard]] std::vector<Headline> VerdictHeadlines(const std::vector<TargetResult>& targets);

/// The answer for each target, and its probability of detection.
[[nodiscard]] Section VerdictSection(const std::vector<TargetResult>& targets);

/// The numerical error of the echoes of what a study follows, over all approaches and by target;
/// absent if no frame is certified. Defined in study_certificate.cpp.
[[nodiscard]] std::optional<RunCertificate> CertificateOfStudy(const StudyResult& result);

/// The section about it; without tables if it is absent.
[[nodiscard]] Section StudyCertificateSection(const std::optional<RunCertificate>& certificate);

/// Adds the option --table.
void AddTable(ProgramOptions& command, std::vector<std::string>& factors);

/// Checks the names of the table's factors before anything is simulated.
/// @throws InputError if there are some, but not two or three different ones.
void CheckTable(const std::vector<std::string>& names);

/// The factors of the table of verdicts that a user names, after the kind of object, if it differs;
/// none without names.
/// @throws InputError as CheckTable(), or if a name is that of no factor.
[[nodiscard]] std::vector<const Factor*> NamedFactors(const std::vector<std::string>& names,
                                                      const std::vector<Factor>& factors);

/// The factors of the table of verdicts where no user names them: the kind of object, if it
/// differs, then those of the greatest weight, up to three. A third is left out if its cells had
/// fewer than 60 approaches on average.
/// @return Of `factors`; none if fewer than two make cells of their own.
[[nodiscard]] std::vector<const Factor*> LargestFactors(
    const std::vector<Observation>& observations,
    const std::vector<Factor>& factors,
    const std::vector<FactorWeight>& weights);

/// The table of verdicts, a row for each combination of the factors' levels that occurs; without
/// tables if there are no factors. Defined in study_table.cpp.
[[nodiscard]] Section TableSection(const std::vector<Observation>& observations,
                                   const std::vector<const Factor*>& factors);

/// Whether a section has nothing to say, as those of what a study does not draw.
[[nodiscard]] bool SaysNothing(const Section& section);
/// What a study asks and its figures depend on.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> FactsOfStudy(
    const StudySpec& study, const StudyRecord& identity, std::size_t num_approaches);

/// Reports a study: for each target whether it is detected in time, with which probability at which
/// distance, what matters for that, the conditions in which it fails, and published distances.
/// @param recipe The recipe's file.
/// @param command Command line that made the report.
/// @pre There is at least one observation.
[[nodiscard]] Report MakeStudyReport(const StudySpec& study,
                                     const Json& recipe,
                                     const StudyResult& result,
                                     const std::vector<Observation>& observations,
                                     const std::string& command);

/// The ten observations that are the worst, those that were missed first, then those with the least
/// to spare.
[[nodiscard]] std::vector<Observation> WorstOf(const std::vector<Observation>& observations);

/// The section of WorstOf() with a command for each.
/// @param folder Of the study, in which `worst/NNNNNN` holds their scenarios.
[[nodiscard]] Section WorstSection(const std::vector<Observation>& worst,
                                   const std::string& folder);

/// Which conditions are bad: shares in time and distances by the factors' levels, their weights,
/// and pairs of levels that fail. Defined in study_conditions.cpp.
/// @param in_table Factors of which the table of verdicts shows the pairs.
[[nodiscard]] Section ConditionsSection(const std::vector<Observation>& observations,
                                        const std::vector<Factor>& factors,
                                        const std::vector<const Factor*>& in_table);
[[nodiscard]] Section FactorsSection(const std::vector<FactorWeight>& weights,
                                     std::size_t num_observations);

/// Which combination of what a recipe draws for the sensor detects each target first; without
/// tables if it draws nothing of it. Defined in study_placement.cpp.
/// @param in_table Factors of the table of verdicts, whose figures are not repeated.
/// @param recipe The recipe's file.
[[nodiscard]] Section PlacementSection(const std::vector<Observation>& observations,
                                       const std::vector<Factor>& factors,
                                       const std::vector<const Factor*>& in_table,
                                       const Json& recipe);

/// False alarms by condition, and each object in each condition. Defined in study_alarms.cpp.
/// @pre The study has a detector, so that all approaches have alarms.
[[nodiscard]] Section StudyAlarmsSection(const StudySpec& study,
                                         const std::vector<ApproachRecord>& approaches);

/// Distances of detection that others have published, and each target beside the driver where one
/// is published for its kind: persons by their type, anything else by the target's name.
[[nodiscard]] Section YardsticksSection(const std::vector<TargetResult>& targets);

}  // namespace railcast
