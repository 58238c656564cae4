#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/frontier/differences.h"
#include "analysis/frontier/kept_frontier.h"
#include "analysis/frontier/rows.h"
#include "core/fidelity/frame_comparison.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// What to measure: rows, frames and repetitions.
struct FrontierPlan {
  std::vector<FrontierRow> rows;
  std::vector<std::uint32_t> frames;
  /// Frames on the way to objects, for their detection distances only.
  std::vector<std::uint32_t> approach_frames{};
  /// Frames on which the numbers of echoes of rows with scene detail `auto` are compared.
  std::vector<std::uint32_t> detail_frames{};
  /// For the timing; errors are computed on all cores, which does not change them.
  int num_threads = 1;
  int num_rounds = 4;  ///< Timing rounds per frame.
  /// Sub-rays per beam of the reference that all rows are compared with.
  int yardstick_rays = 1024;
};

/// The errors of a row on all frames.
struct RowErrors : FrameDifference {
  std::vector<Approach> approaches;  ///< One for each object that is approached.
};

/// Result of one row: times over all frames and rounds, and the errors of its frames.
struct RowResult {
  FrontierRow row;
  std::vector<double> times_ms;  ///< Times of single frames, sorted at the end.
  /// Absent for the raw trace and for rows with scene detail `auto`.
  std::optional<RowErrors> difference;
  /// Median time divided by that of the raw trace in the same round, for each round that timed the
  /// row.
  std::vector<double> ratios;
  /// Of a row with scene detail `auto`, against the same row in full detail.
  std::vector<DetailDifference> detail_differences{};

  [[nodiscard]] double p50_ms() const { return TimeQuantile_ms(0.5); }
  [[nodiscard]] double p99_ms() const { return TimeQuantile_ms(0.99); }
  /// Median of the ratios over the rounds. A machine's speed varies with time, but the raw trace of
  /// the same moment varies with it.
  [[nodiscard]] double ratio() const;

 private:
  [[nodiscard]] double TimeQuantile_ms(double q) const;
};

/// Called with the completed share of the work, in [0, 1].
using FrontierProgress = std::function<void(const std::string& what, double done)>;

/// The share of the work that an earlier run has done.
[[nodiscard]] double KeptShare(const FrontierPlan& plan, const KeptFrontier& kept);

/// Times the rows, interleaved in this process, and compares their frames with those of the
/// reference.
/// @param scenario In full detail.
/// @param simulator Made from the scenario; its spec is restored afterwards.
/// @param kept What an earlier run has measured is taken from there; what this one measures is kept
///   there.
[[nodiscard]] std::vector<RowResult> MeasureFrontier(const FrontierPlan& plan,
                                                     const ScenarioSpec& scenario,
                                                     Simulator& simulator,
                                                     const KeptFrontier& kept,
                                                     const FrontierProgress& on_progress);

}  // namespace railcast
