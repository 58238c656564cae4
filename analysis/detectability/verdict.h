#pragma once

#include <string>
#include <vector>

#include "analysis/detectability/detect_report.h"
#include "analysis/estimate/moments.h"

namespace railcast {

/// What all runs together say of one object.
struct Verdict {
  std::string name;
  std::string type;
  std::string label;
  std::uint64_t num_approached{};  ///< Runs.
  std::uint64_t num_detected{};
  std::uint64_t num_in_time{};
  std::uint64_t num_from_start{};
  Moments distance_m;      ///< Of detection.
  Moments spare_m;         ///< Distance to spare where it was detected.
  double least_spare_m{};  ///< NaN if it never was.
  double most_needed_m{};  ///< NaN if it was never approached.

  /// "in time in all 12 runs", "too late in 1 of 12 runs, not detected in 2", "never approached".
  [[nodiscard]] std::string InWords() const;
};

/// In order of the objects' names.
[[nodiscard]] std::vector<Verdict> MakeVerdicts(const std::vector<DetectRun>& runs);

}  // namespace railcast
