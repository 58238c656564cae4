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
  bool is_in_way{};                ///< In any run: else there is nothing to judge.
  double from_axis_m{};            ///< The least of all runs, from the own track's axis, across.
  std::uint64_t num_approached{};  ///< Runs.
  std::uint64_t num_detected{};
  std::uint64_t num_in_time{};
  /// Runs that began so near that the object was detected at once, and too late: had they begun
  /// farther off, it might have been in time.
  std::uint64_t num_undecided{};
  Moments distance_m;         ///< Of detection, where it was not at once.
  Moments spare_m;            ///< Distance to spare, likewise.
  double least_distance_m{};  ///< Of detection, likewise; NaN if it was always at once or never.
  double least_spare_m{};     ///< Of the runs that are decided; NaN if there is none.
  double most_needed_m{};     ///< NaN if it was never approached.

  /// Whether any run that approached it began far enough off to judge it.
  [[nodiscard]] bool is_judged() const { return is_in_way && num_approached > num_undecided; }
  /// Whether all that approached it began too near.
  [[nodiscard]] bool is_begun_too_near() const {
    return is_in_way && num_approached > 0 && num_approached == num_undecided;
  }
  /// Whether every run that could be judged detected it in time.
  [[nodiscard]] bool is_always_in_time() const {
    return is_judged() && num_in_time + num_undecided == num_approached;
  }

  /// "in time in all 12 runs", "too late in 1 of 12 runs, not detected in 2", "never approached".
  [[nodiscard]] std::string InWords() const;
};

/// In order of the objects' names.
[[nodiscard]] std::vector<Verdict> MakeVerdicts(const std::vector<DetectRun>& runs);

}  // namespace railcast
