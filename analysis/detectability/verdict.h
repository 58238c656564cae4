#pragma once

#include <string>
#include <vector>

#include "analysis/detectability/detect_report.h"
#include "analysis/estimate/moments.h"

namespace railcast {

/// The result for one object over all runs.
struct Verdict {
  std::string name;
  std::string type;
  std::string label;
  bool is_in_way{};  ///< In any run; otherwise there is nothing to judge.
  /// Least lateral distance from the own track's axis over all runs.
  double from_axis_m{};
  std::uint64_t num_approached{};  ///< Number of runs that approached it.
  std::uint64_t num_detected{};
  std::uint64_t num_in_time{};
  /// Runs that began so near that the object was detected at once, yet too late: had they begun
  /// farther away, the detection might have been in time.
  std::uint64_t num_undecided{};
  Moments distance_m;  ///< Distance of detection in the runs that did not detect it at once.
  Moments spare_m;     ///< Distance to spare in the same runs.
  /// Least distance of detection in the same runs; NaN if there is none.
  double least_distance_m{};
  double least_spare_m{};  ///< Over the runs that are decided; NaN if there is none.
  double most_needed_m{};  ///< NaN if the object was never approached.

  /// Whether any run that approached the object began far enough away to judge it.
  [[nodiscard]] bool is_judged() const { return is_in_way && num_approached > num_undecided; }
  /// Whether all runs that approached the object began too near.
  [[nodiscard]] bool is_begun_too_near() const {
    return is_in_way && num_approached > 0 && num_approached == num_undecided;
  }
  /// Whether every run that could be judged detected the object in time.
  [[nodiscard]] bool is_always_in_time() const {
    return is_judged() && num_in_time + num_undecided == num_approached;
  }

  /// "in time in all 12 runs", "too late in 1 of 12 runs, not detected in 2", "never approached".
  [[nodiscard]] std::string InWords() const;
};

/// Returns one verdict per object, in order of their names.
[[nodiscard]] std::vector<Verdict> MakeVerdicts(const std::vector<DetectRun>& runs);

}  // namespace railcast
