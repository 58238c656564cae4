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
  /// Runs that began so near that the object was detected at once, and too late: had they begun
  /// farther off, it might have been in time.
  std::uint64_t num_undecided{};
  Moments distance_m;      ///< Of detection, where it was not at once.
  Moments spare_m;         ///< Distance to spare, likewise.
  double least_spare_m{};  ///< Of the runs that are decided; NaN if there is none.
  double most_needed_m{};  ///< NaN if it was never approached.

  /// "in time in all 12 runs", "too late in 1 of 12 runs, not detected in 2", "never approached".
  [[nodiscard]] std::string InWords() const;
};

/// In order of the objects' names.
[[nodiscard]] std::vector<Verdict> MakeVerdicts(const std::vector<DetectRun>& runs);

}  // namespace railcast
