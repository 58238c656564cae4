#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "analysis/detectability/object_detection.h"
#include "analysis/estimate/estimate.h"
#include "analysis/extras/detectors/run_evaluation.h"
#include "analysis/report/report.h"

namespace railcast {

/// The words of evaluations (report/words.h).
extern const char* const kDetectorsWords;

/// An object that must raise no alarm, over all runs.
struct ObjectBeside {
  std::string type;
  double from_axis_m = std::numeric_limits<double>::infinity();
  std::uint64_t num_runs{};  ///< Runs that come near it.
  std::uint64_t num_runs_with_alarm{};
  std::uint64_t num_alarms{};
};

/// By name.
[[nodiscard]] std::map<std::string, ObjectBeside> ObjectsBesideIn(
    const std::vector<EvaluatedRun>& runs);

[[nodiscard]] double SumDriven_m(const std::vector<EvaluatedRun>& runs);

/// False alarms per kilometre, with the exact interval for any number of them.
[[nodiscard]] Estimate AlarmsPerKm(std::uint64_t num_alarms, double driven_m);

/// What a false alarm is, in sentences.
[[nodiscard]] std::string FalseAlarmText(const DetectionRule& rule);

/// The false alarms of runs: by what raised them, at objects that must raise none, and each.
[[nodiscard]] Section AlarmSection(const std::vector<EvaluatedRun>& runs,
                                   const DetectionRule& rule);

}  // namespace railcast
