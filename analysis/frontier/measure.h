#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/frontier/rows.h"
#include "core/fidelity/frame_comparison.h"
#include "core/scenario/scenario_spec.h"
#include "core/simulate/simulator.h"

namespace railcast {

/// What a frontier is measured on.
struct FrontierPlan {
  std::vector<FrontierRow> rows;
  std::vector<std::uint32_t> frames;
  int num_threads = 1;        ///< Of the timing; errors take all cores, which changes none.
  int num_rounds = 4;         ///< Of the timing, of each frame.
  int yardstick_rays = 1024;  ///< Sub-rays of what all rows are compared with.
};

/// Of one row: times over all frames and rounds, and what is wrong with its frames.
struct RowResult {
  FrontierRow row;
  std::vector<double> times_ms;               ///< Of single frames, sorted at last.
  std::optional<FrameDifference> difference;  ///< None of the raw trace.
  /// Median time / the raw trace's of the same round, for each round that timed it.
  std::vector<double> ratios;

  [[nodiscard]] double p50_ms() const { return TimeQuantile_ms(0.5); }
  [[nodiscard]] double p99_ms() const { return TimeQuantile_ms(0.99); }
  /// The median over the rounds. Machines change their speed; the raw trace of the same second
  /// does, too.
  [[nodiscard]] double ratio() const;

 private:
  [[nodiscard]] double TimeQuantile_ms(double q) const;
};

/// Called with the share of the work that is done, in [0, 1].
using FrontierProgress = std::function<void(const std::string& what, double done)>;

/// Times the rows, interleaved in this process, and compares their frames with the reference's.
/// @param simulator The scenario's; its spec is what it was afterwards.
[[nodiscard]] std::vector<RowResult> MeasureFrontier(const FrontierPlan& plan,
                                                     const ScenarioSpec& scenario,
                                                     Simulator& simulator,
                                                     const FrontierProgress& on_progress);

}  // namespace railcast
