#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/frontier/differences.h"
#include "analysis/frontier/kept_frontier.h"
#include "core/fidelity/frame_comparison.h"
#include "railcast/effects.h"
#include "railcast/fidelity.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// The series of the chart that a row belongs to.
enum class RowGroup {
  kRawTrace,    ///< The reference of time: ray tracing only.
  kLadder,      ///< The rungs, and rung surface with wires.
  kBetween,     ///< A rung without one of its effects.
  kBruteForce,  ///< The same number of sub-rays in every beam, with wires as triangles.
  kReference,   ///< The reference of accuracy with fewer sub-rays.
  kChosen,      ///< What fidelity auto chooses.
  kAutoDetail,  ///< A rung with scene detail `auto`, whose echoes cannot be matched one by one.
};
[[nodiscard]] const char* RowGroupName(RowGroup group);

/// A way of making frames whose time and errors are measured.
struct FrontierRow {
  std::string name;
  RowGroup group{};
  EffectSet effects{};
  std::optional<int> sub_rays{};  ///< Sub-rays of dense_footprint beside the central ray.
  int footprint_rays = 64;        ///< BeamSpec::footprint_rays.
  std::vector<std::uint32_t> footprint_labels{};  ///< DetectorSpec::footprint_labels.

  /// Whether the scene is as coarse as detail `auto` permits; otherwise it is in full detail.
  [[nodiscard]] bool has_auto_detail() const { return group == RowGroup::kAutoDetail; }
  /// Whether its echoes are compared with those of the reference.
  [[nodiscard]] bool is_matched() const {
    return group != RowGroup::kRawTrace && group != RowGroup::kAutoDetail;
  }
};

/// Returns all rows in the order of the table. UseChoice() fills in the rows `auto` and
/// `footprint_of`.
[[nodiscard]] std::vector<FrontierRow> AllFrontierRows();

/// Chooses rows by a comma-separated list of names, or "all". The raw trace is always included,
/// since times are given as its multiples.
/// @throws InputError that names the unknown rows.
[[nodiscard]] std::vector<FrontierRow> ChooseFrontierRows(const std::string& names);

/// Gives the row `auto` what fidelity auto has chosen, and the row `footprint_of` the classes of
/// that choice or, if it has none, all but ground, ballast, sleepers, roads and plants.
void UseChoice(const FidelityChoice& choice,
               const LabelTable& labels,
               std::vector<FrontierRow>& rows);

/// The scenario's spec with a row's effects. The published model's threshold comes from the same
/// data-sheet figure as the physical one: 10 % reflectance is just detected at
/// range_at_10_percent_m.
[[nodiscard]] SimulatorSpec SpecOfRow(const FrontierRow& row, const SimulatorSpec& scenario);

/// The simulators that make the frames of rows: one in full detail for most of them, and one more
/// for each choice of scene detail `auto`, which depends on whether the beams have a width.
class RowSimulators {
 public:
  /// @param scenario In full detail.
  /// @param full_detail Its simulator; must outlive this object.
  RowSimulators(const ScenarioSpec& scenario,
                Simulator& full_detail,
                const std::vector<FrontierRow>& rows);

  [[nodiscard]] Simulator& Of(const FrontierRow& row);
  /// Sets the number of threads of all of them.
  void UseThreads(int num_threads);
  /// Builds the windows of a frame, so that no row's time contains that.
  void BuildWindows(std::uint32_t frame);

 private:
  Simulator& full_detail_;
  std::map<bool, std::unique_ptr<Simulator>> auto_detail_;  ///< By whether beams have a width.
};

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
  /// The processor's time for all times of times_ms, by frame.
  std::vector<double> processor_ms{};
  std::vector<double> spreads{};  ///< 99 % quantile over median of the times of each frame.
  /// For a row with scene detail `auto`, against the same row in full detail.
  std::vector<DetailDifference> detail_differences{};

  [[nodiscard]] double p50_ms() const { return TimeQuantile_ms(0.5); }
  [[nodiscard]] double p99_ms() const { return TimeQuantile_ms(0.99); }
  /// Median of the ratios over the rounds. A machine's speed varies with time, but the raw trace of
  /// the same moment varies with it.
  [[nodiscard]] double ratio() const;

 private:
  [[nodiscard]] double TimeQuantile_ms(double q) const;
};

/// Whether a machine had time for what was timed on it.
struct TimingConditions {
  /// Share of one thread's time that the processor spent on it; 1 with several threads, whose waits
  /// for each other tell nothing.
  double processor_share = 1.0;
  /// 99 % quantile over median of the times of the raw trace, on the frame where that is greatest.
  double raw_spread = 1.0;

  /// An idle machine has shares above 0.99 and spreads below 1.2.
  [[nodiscard]] bool is_busy() const { return processor_share < 0.9 || raw_spread > 2.0; }
};

/// @param results The first is the raw trace.
[[nodiscard]] TimingConditions ConditionsOf(const FrontierPlan& plan,
                                            const std::vector<RowResult>& results);

/// What is to be said of the times; empty unless the machine was busy.
[[nodiscard]] std::string BusyText(const TimingConditions& conditions);

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
