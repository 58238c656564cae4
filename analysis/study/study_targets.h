#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "analysis/estimate/detection_curve.h"
#include "analysis/report/report.h"
#include "analysis/study/study_factors.h"

namespace railcast {

/// What a study knows of one target: of a kind of object in the way, over all approaches.
struct TargetResult {
  std::string name{};
  std::string type{};  ///< Of its first object.
  std::vector<Inspection> inspections{};
  std::vector<double> detected_m{};  ///< Of each approach; 0 without detection.
  std::uint64_t num_detected{};
  std::uint64_t num_in_time{};
  std::uint64_t num_undecided{};
  double least_distance_m = std::numeric_limits<double>::quiet_NaN();  ///< Of the detections.
  double most_needed_m = std::numeric_limits<double>::quiet_NaN();
  /// Of the distances of detection; NaN with fewer approaches than a fit takes, or where so many
  /// detect nothing that no distance has that confidence.
  double d90_95_m = std::numeric_limits<double>::quiet_NaN();
  /// What 90 % do not exceed with 95 % confidence: if this is less than needed, it is too late.
  double d90_at_most_m = std::numeric_limits<double>::quiet_NaN();
  DetectionFit fit{};  ///< Of its distances, all are NaN with fewer inspections than it takes.

  [[nodiscard]] bool has_fit() const { return inspections.size() >= DetectionFit::kMinTargets; }
};

/// By name.
[[nodiscard]] std::vector<TargetResult> TargetsOf(const std::vector<Observation>& observations);

/// Whether it is detected in time: "yes", "no", "not shown", or why that is not known.
[[nodiscard]] std::string AnswerOf(const TargetResult& target);

/// The answer for each target, and its probability of detection.
[[nodiscard]] Section VerdictSection(const std::vector<TargetResult>& targets);

}  // namespace railcast
