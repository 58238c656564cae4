#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/detectability/object_detection.h"
#include "analysis/extras/detectors/cluster_detector.h"
#include "analysis/extras/detectors/run_evaluation.h"
#include "analysis/report/report.h"
#include "railcast/io/recording.h"

namespace railcast {

/// How a detector is evaluated.
struct EvaluationSpec {
  DetectSpec detect;  ///< Points of the rule do not count: what a detector reports is seen.
  std::optional<TrainGauge> gauge;  ///< In place of the vehicle's outline.
  bool has_files{};                 ///< Whether detections come from files.
  ClusterDetectorSpec clusters;     ///< For the reference detector, if they do not.
  double min_score{};               ///< Least score of detections from files.
};

/// Reports how a detector does: for each object in the way whether it is detected in time, false
/// alarms per kilometre and where they come from, and the objects that must raise no alarm.
/// @param infos Of the runs, in their order.
/// @param command Command line that made the report.
[[nodiscard]] Report MakeEvaluateReport(const std::vector<EvaluatedRun>& runs,
                                        const std::vector<RecordingInfo>& infos,
                                        const EvaluationSpec& spec,
                                        const std::string& command);

/// What is suspect of boxes from files: a line for each run of which none reaches into the gauge,
/// or where something is in the way and none is of an object.
[[nodiscard]] std::vector<std::string> BoxWarnings(const std::vector<EvaluatedRun>& runs);

/// What the reference detector is, in a sentence with its parameters.
[[nodiscard]] std::string ClusterDetectorText(const ClusterDetectorSpec& spec);

}  // namespace railcast
