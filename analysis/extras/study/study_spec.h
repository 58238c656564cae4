#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/detectability/object_detection.h"
#include "analysis/extras/detectors/cluster_detector.h"
#include "analysis/extras/detectors/detection.h"

namespace railcast {

/// How the probability of rare failures is sought.
struct RareSpec {
  std::string cheap{};  ///< The rung on which most approaches are made; empty: the recipe's own.
  std::uint32_t per_stage = 300;
  double precision = 0.3;
  std::uint32_t most_approaches = 20'000;
  /// How rare a kind of failure may be that is met although no search leads to it (RareSettings).
  std::optional<double> unseen{};
};

inline constexpr double kMostUnseen = 0.1;
/// The least that RareSpec::unseen may be: 3 / unseen approaches are at most a quarter of all.
[[nodiscard]] inline double LeastUnseen(const RareSpec& rare) {
  return 12.0 / rare.most_approaches;
}

/// A study: what is asked of the scenarios of a recipe (docs/study.md).
struct StudySpec {
  std::filesystem::path file;
  std::string question;  ///< In the words of whoever asks; may be empty.
  std::string recipe;    ///< Absolute name of the recipe's file.
  /// What is asked about: names of objects ("wagons/3"), or of all that are placed under a name
  /// ("person"). Empty = all that come in the way.
  std::vector<std::string> objects;
  DetectSpec detect;
  /// Whose detections are studied; absent = an object is seen by the number of points on it.
  std::optional<ClusterDetectorSpec> detector;
  std::optional<TrainGauge> gauge;  ///< The train's gauge, in place of the vehicle's outline.
  /// Names of the factors of the table of verdicts, which the option --table says, not the file.
  /// Empty = those that matter most.
  std::vector<std::string> table;
  std::optional<RareSpec> rare;  ///< Absent: all approaches are as the recipe draws them.

  /// What is asked about, for pages: "wagons/3, person", or "all objects in the way".
  [[nodiscard]] std::string ObjectsText() const;
};

/// Reads a study as strictly as a scenario.
/// @throws InputError with a line for every fault: "file: /pointer: rule (got value)".
[[nodiscard]] StudySpec ReadStudy(const std::filesystem::path& file);

}  // namespace railcast
