#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/detectability/approach.h"
#include "analysis/detectability/object_detection.h"
#include "analysis/detectability/rung_used.h"
#include "analysis/report/report.h"

namespace railcast {

/// The settings that apply to every run.
struct DetectSpec {
  DetectionRule rule;
  BrakingSpec braking;
  /// Absent: the vehicle's own speed when the object is detected.
  std::optional<double> speed_mps;
};

/// One run of a scenario, with its own seed.
struct DetectRun {
  std::filesystem::path source;
  std::uint64_t seed{};
  RunCourses courses;
  std::map<std::string, ObjectDetection> detections;  ///< By the object's name.
};

/// @throws InputError "source: object NAME: ..." if the train cannot stop.
[[nodiscard]] DetectRun DetectInRun(std::filesystem::path source,
                                    std::uint64_t seed,
                                    RunCourses courses,
                                    const DetectSpec& spec);

/// Reports which objects are detected in time to stop: a verdict for each object over all runs,
/// each run's detection, and number of points against distance beside the distance needed.
/// @param command Command line that made the report.
/// @param facts Describe the scenario.
/// @param rung The rung of the runs, with a warning where it sends one ray per beam.
/// @pre There is at least one run.
[[nodiscard]] Report MakeDetectReport(const std::vector<DetectRun>& runs,
                                      const DetectSpec& spec,
                                      const std::string& command,
                                      std::vector<std::pair<std::string, std::string>> facts,
                                      const RungUsed& rung);

}  // namespace railcast
