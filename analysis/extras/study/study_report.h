#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "analysis/estimate/detection_curve.h"
#include "analysis/extras/study/run_study.h"
#include "analysis/extras/study/study_factors.h"
#include "analysis/extras/study/study_spec.h"
#include "analysis/report/report.h"

namespace railcast {

/// What a study knows of one target: of a kind of object in the way, over all approaches.
struct TargetResult {
  std::string name{};
  std::string type{};  ///< Of its first object.
  ObservedGroup seen{};
  double least_distance_m = std::numeric_limits<double>::quiet_NaN();  ///< Of the detections.
  double most_needed_m = std::numeric_limits<double>::quiet_NaN();
  /// Of the distances of detection; NaN with fewer approaches than a fit takes, or where so many
  /// detect nothing that no distance has that confidence.
  double d90_95_m = std::numeric_limits<double>::quiet_NaN();
  /// What 90 % do not exceed with 95 % confidence: if this is less than needed, it is too late.
  double d90_at_most_m = std::numeric_limits<double>::quiet_NaN();
  DetectionFit fit{};  ///< Of its distances, all are NaN with fewer inspections than it takes.

  [[nodiscard]] bool has_fit() const { return seen.num >= DetectionFit::kMinTargets; }
};

/// By name.
[[nodiscard]] std::vector<TargetResult> TargetsOf(const std::vector<Observation>& observations);

/// Whether it is detected in time: "yes", "no", "not shown", or why that is not known.
[[nodiscard]] std::string AnswerOf(const TargetResult& target);

/// The answer for each target, and its probability of detection.
[[nodiscard]] Section VerdictSection(const std::vector<TargetResult>& targets);

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
[[nodiscard]] Section ConditionsSection(const std::vector<Observation>& observations,
                                        const std::vector<Factor>& factors);
[[nodiscard]] Section FactorsSection(const std::vector<FactorWeight>& weights,
                                     std::size_t num_observations);

/// Which combination of what a recipe draws for the sensor detects each target first; without
/// tables if it draws nothing of it. Defined in study_placement.cpp.
/// @param recipe The recipe's file.
[[nodiscard]] Section PlacementSection(const std::vector<Observation>& observations,
                                       const std::vector<Factor>& factors,
                                       const Json& recipe);

/// False alarms by condition, and each object in each condition. Defined in study_alarms.cpp.
/// @pre The study has a detector, so that all approaches have alarms.
[[nodiscard]] Section StudyAlarmsSection(const StudySpec& study,
                                         const std::vector<ApproachRecord>& approaches);

/// Distances of detection that others have published, and each target beside the driver where one
/// is published for its kind: persons by their type, anything else by the target's name.
[[nodiscard]] Section YardsticksSection(const std::vector<TargetResult>& targets);

}  // namespace railcast
