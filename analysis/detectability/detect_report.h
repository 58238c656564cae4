#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/detectability/approach.h"
#include "analysis/detectability/braking.h"
#include "analysis/detectability/detection.h"
#include "analysis/report/report.h"

namespace railcast {

/// What is asked of every run.
struct DetectSpec {
  DetectionRule rule;
  BrakingSpec braking;
  std::optional<double> speed_mps;  ///< Absent: the vehicle's own when the object is detected.
};

/// One run of a scenario, with a seed of its own.
struct DetectRun {
  std::filesystem::path source;
  std::uint64_t seed{};
  RunCourses courses;
  std::map<std::string, Detection> detections;  ///< By the object's name.
};

/// @throws InputError "source: object NAME: ..." if the train cannot stop.
[[nodiscard]] DetectRun DetectInRun(std::filesystem::path source,
                                    std::uint64_t seed,
                                    RunCourses courses,
                                    const DetectSpec& spec);

/// Who is seen in time to stop: a verdict for each object over all runs, each run's detection, and
/// points against distance beside the distance that is needed.
/// @param command That made it. @param facts Of the scenario. @pre At least one run.
[[nodiscard]] Report MakeDetectReport(const std::vector<DetectRun>& runs,
                                      const DetectSpec& spec,
                                      const std::string& command,
                                      std::vector<std::pair<std::string, std::string>> facts);

}  // namespace railcast
