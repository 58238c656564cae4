#include "analysis/frontier/measure.h"

#include <ctime>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/fidelity/beam_steps.h"

namespace railcast {
namespace {

constexpr int kScansPerRound = 3;
// A row as slow as this is scanned once per round: warm caches would change little.
constexpr double kSlow_ms = 250.0;
// Total time that suffices for a row, beyond one scan of each frame.
constexpr double kEnough_ms = 10'000.0;

/// By the clock, and by the processor on all threads.
struct Spent {
  double time_ms{};
  double processor_ms{};
};

double Processor_ms() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

Spent SpentOn(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  const double begin_ms = Processor_ms();
  work();
  const double processor_ms = Processor_ms() - begin_ms;
  return {
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count(),
      processor_ms};
}

// @param times_ms In order.
double RankedQuantile(const std::vector<double>& times_ms, double q) {
  Check(!times_ms.empty(), "a row has been timed");
  const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(times_ms.size())));
  return times_ms[std::max<std::size_t>(rank, 1) - 1];
}

class Stopwatch {
 public:
  Stopwatch(const SimulatorSpec& spec, RowSimulators& simulators)
      : spec_(spec), simulators_(simulators) {}

  // The times of all rows on one frame, in rounds.
  // @param before The rows with their times on earlier frames. The first is the raw trace.
  std::vector<RowTimes> TimesOn(std::uint32_t frame,
                                const FrontierPlan& plan,
                                const std::vector<RowResult>& before) {
    simulators_.UseThreads(plan.num_threads);
    simulators_.BuildWindows(frame);
    const std::function<void()> raw_trace = simulators_.Of(before.front().row).MakeRawTrace(frame);
    std::vector<RowTimes> rows(before.size());
    for (int round = 0; round < plan.num_rounds; ++round) {
      Round(frame, raw_trace, before, rows);
    }
    return rows;
  }

 private:
  void Round(std::uint32_t frame,
             const std::function<void()>& raw_trace,
             const std::vector<RowResult>& before,
             std::vector<RowTimes>& rows) {
    double raw_ms = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const bool is_raw = before[i].row.group == RowGroup::kRawTrace;
      Simulator& simulator = simulators_.Of(before[i].row);
      if (!is_raw) simulator.Use(SpecOfRow(before[i].row, spec_));
      const std::function<void()> scan = [&] { simulator.Scan(frame, frame_); };
      const bool has_enough = SumOf(before[i].times_ms) + SumOf(rows[i].times_ms) > kEnough_ms;
      if (has_enough && !rows[i].times_ms.empty()) continue;
      std::vector<double> times_ms;
      for (const Spent& spent : TimesOf(is_raw ? raw_trace : scan)) {
        times_ms.push_back(spent.time_ms);
        rows[i].processor_ms.push_back(spent.processor_ms);
      }
      rows[i].times_ms.insert(rows[i].times_ms.end(), times_ms.begin(), times_ms.end());
      std::sort(times_ms.begin(), times_ms.end());
      const double median_ms = times_ms[times_ms.size() / 2];
      if (is_raw) raw_ms = median_ms;
      rows[i].ratios.push_back(median_ms / raw_ms);
    }
  }

  static double SumOf(const std::vector<double>& times_ms) {
    return std::accumulate(times_ms.begin(), times_ms.end(), 0.0);
  }

  static std::vector<Spent> TimesOf(const std::function<void()>& work) {
    const Spent first = SpentOn(work);  // The caches still hold another row's data.
    if (first.time_ms > kSlow_ms) return {first};
    std::vector<Spent> times;
    for (int i = 0; i < kScansPerRound; ++i) times.push_back(SpentOn(work));
    return times;
  }

  const SimulatorSpec& spec_;
  RowSimulators& simulators_;
  Frame frame_;
};

void AddTimes(const std::vector<RowTimes>& rows, std::vector<RowResult>& results) {
  Check(rows.size() == results.size(), "every row has its times");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& [times_ms, ratios, processor_ms] = rows[i];
    results[i].processor_ms.insert(results[i].processor_ms.end(), processor_ms.begin(),
                                   processor_ms.end());
    std::vector<double> sorted = times_ms;
    std::ranges::sort(sorted);
    if (!sorted.empty()) {
      results[i].spreads.push_back(RankedQuantile(sorted, 0.99) / RankedQuantile(sorted, 0.5));
    }
    results[i].times_ms.insert(results[i].times_ms.end(), times_ms.begin(), times_ms.end());
    results[i].ratios.insert(results[i].ratios.end(), ratios.begin(), ratios.end());
  }
}

// Errors are computed over all echoes and before range noise.
SimulatorSpec ComparedSpec(const FrontierRow& row, const SimulatorSpec& scenario) {
  SimulatorSpec spec = SpecOfRow(row, scenario);
  spec.detector.effects = WithoutRangeErrors(spec.detector.effects);
  spec.detector.receiver.return_mode = ReturnMode::kTriple;
  return spec;
}

// The steps within the beams of a frame, with the effects of `compared`. Rays without a width have
// none.
std::vector<float> StepsWith(const SimulatorSpec& compared,
                             const StepLimits& limits,
                             std::uint32_t frame,
                             Simulator& simulator) {
  const EffectSet& effects = compared.detector.effects;
  if (!effects.footprint && !effects.thin_conductors) {
    return std::vector<float>(simulator.pattern().num_firings(),
                              std::numeric_limits<float>::quiet_NaN());
  }
  Frame parts;
  simulator.Use(ShowParts(compared));
  simulator.Scan(frame, parts);
  return StepsOf(parts, compared.detector.beam, limits);
}

// Shares of the work on a sample frame, whose whole is 1: with it comes what the scan of a frame of
// the reference takes. Frames on the way to objects are scanned, but not timed.
constexpr double kTimingShare = 0.5;
constexpr double kReferenceShare = 0.4;
constexpr double kErrorsShare = 0.1;
constexpr double kDetailFrameShare = 0.02;

double WorkOf(const FrontierPlan& plan) {
  return static_cast<double>(plan.frames.size()) +
         (kReferenceShare + kErrorsShare) * static_cast<double>(plan.approach_frames.size()) +
         kDetailFrameShare * static_cast<double>(plan.detail_frames.size());
}

/// Reports the progress in steps.
class Steps {
 public:
  Steps(const FrontierPlan& plan, const FrontierProgress& on_progress)
      : all_(WorkOf(plan)), on_progress_(on_progress) {}

  /// Begins a step.
  void Begin(const std::string& what, double work) {
    on_progress_(what, done_ / all_);
    done_ += work;
  }

 private:
  double all_;
  const FrontierProgress& on_progress_;
  double done_ = 0.0;
};

/// Scans frames of the reference, or takes them from an earlier run.
class Reference {
 public:
  Reference(SimulatorSpec spec, const KeptFrontier& kept, Simulator& simulator)
      : spec_(std::move(spec)), kept_(kept), simulator_(simulator) {}

  [[nodiscard]] Frame FrameOf(std::uint32_t index) const {
    return kept_.FrameOf(index, [&] {
      Frame frame;
      simulator_.Use(spec_);
      simulator_.Scan(index, frame);
      return frame;
    });
  }
  [[nodiscard]] std::vector<float> StepsOf_m(std::uint32_t index) const {
    return kept_.StepsOf(index,
                         [&] { return StepsWith(spec_, kReferenceSteps, index, simulator_); });
  }

 private:
  SimulatorSpec spec_;
  const KeptFrontier& kept_;
  Simulator& simulator_;
};

// The points of each object on the frames on the way to it, for each row.
std::vector<std::vector<Approach>> MeasureApproaches(const FrontierPlan& plan,
                                                     const Reference& of_reference,
                                                     const SimulatorSpec& spec,
                                                     Simulator& simulator,
                                                     Steps& steps) {
  std::vector<std::vector<Approach>> approaches(plan.rows.size(), ApproachesIn(simulator.world()));
  Frame other;
  for (const std::uint32_t frame : plan.approach_frames) {
    steps.Begin("detection distances, frame " + std::to_string(frame),
                kReferenceShare + kErrorsShare);
    const Frame reference = of_reference.FrameOf(frame);
    for (std::size_t i = 0; i < plan.rows.size(); ++i) {
      if (!plan.rows[i].is_matched()) continue;
      simulator.Use(ComparedSpec(plan.rows[i], spec));
      simulator.Scan(frame, other);
      AddApproach(simulator, reference, other, approaches[i]);
    }
  }
  return approaches;
}

// The same row in full detail.
FrontierRow InFullDetail(FrontierRow row) {
  row.group = RowGroup::kLadder;
  return row;
}

void MeasureDetail(const FrontierPlan& plan,
                   const SimulatorSpec& spec,
                   RowSimulators& simulators,
                   std::vector<RowResult>& results) {
  Frame frame;
  for (RowResult& result : results) {
    if (!result.row.has_auto_detail()) continue;
    const auto count = [&](const FrontierRow& row) {
      EchoesByRange echoes(kDetailBin_m);
      Simulator& simulator = simulators.Of(row);
      simulator.Use(ComparedSpec(row, spec));
      for (const std::uint32_t index : plan.detail_frames) {
        simulator.Scan(index, frame);
        echoes.AddFrame(frame);
      }
      return echoes;
    };
    const EchoesByRange full = count(InFullDetail(result.row));
    result.detail_differences = DifferencesOfDetail(full, count(result.row));
  }
}

}  // namespace

double RowResult::TimeQuantile_ms(double q) const {
  return RankedQuantile(times_ms, q);
}

double RowResult::ratio() const {
  std::vector<double> sorted = ratios;
  std::sort(sorted.begin(), sorted.end());
  return sorted[sorted.size() / 2];
}

TimingConditions ConditionsOf(const FrontierPlan& plan, const std::vector<RowResult>& results) {
  TimingConditions conditions;
  double time_ms = 0.0;
  double processor_ms = 0.0;
  for (const RowResult& result : results) {
    time_ms += std::accumulate(result.times_ms.begin(), result.times_ms.end(), 0.0);
    processor_ms += std::accumulate(result.processor_ms.begin(), result.processor_ms.end(), 0.0);
  }
  if (plan.num_threads == 1 && processor_ms > 0.0)
    conditions.processor_share = processor_ms / time_ms;
  const std::vector<double>& spreads = results.front().spreads;
  if (!spreads.empty()) conditions.raw_spread = *std::ranges::max_element(spreads);
  return conditions;
}

std::string BusyText(const TimingConditions& conditions) {
  if (!conditions.is_busy()) return "";
  return "Busy machine: times are not to be used (the processor spent " +
         NumberText(std::round(100.0 * conditions.processor_share)) +
         " % of the time on them; the raw trace took up to " + ShortText(conditions.raw_spread) +
         " times its median).";
}

double KeptShare(const FrontierPlan& plan, const KeptFrontier& kept) {
  double done = 0.0;
  for (const std::uint32_t frame : plan.frames) {
    done += kept.HasTimes(frame) ? kTimingShare : 0.0;
    done += kept.HasFrame(frame) ? kReferenceShare : 0.0;
  }
  for (const std::uint32_t frame : plan.approach_frames) {
    done += kept.HasFrame(frame) ? kReferenceShare : 0.0;
  }
  return done / WorkOf(plan);
}

std::vector<RowResult> MeasureFrontier(const FrontierPlan& plan,
                                       const ScenarioSpec& scenario,
                                       Simulator& simulator,
                                       const KeptFrontier& kept,
                                       const FrontierProgress& on_progress) {
  const SimulatorSpec spec = simulator.spec();
  std::vector<RowResult> results;
  for (const FrontierRow& row : plan.rows) results.push_back({row, {}, {}, {}});
  const ComparisonSpec comparison =
      MakeComparisonSpec(scenario.lidar.beam, scenario.lidar.range_max_m,
                         LabelTable(scenario.labels), simulator.world().objects());
  std::vector<FrameComparison> comparisons(results.size(), FrameComparison(comparison));
  const FrontierRow yardstick{"yardstick", RowGroup::kReference, YardstickEffects(),
                              plan.yardstick_rays};
  const Reference of_reference(ComparedSpec(yardstick, spec), kept, simulator);
  RowSimulators simulators(scenario, simulator, plan.rows);
  Stopwatch stopwatch(spec, simulators);
  Steps steps(plan, on_progress);
  Frame other;
  for (const std::uint32_t frame : plan.frames) {
    steps.Begin("timing frame " + std::to_string(frame), kTimingShare);
    AddTimes(kept.TimesOf(frame, [&] { return stopwatch.TimesOn(frame, plan, results); }), results);
    simulators.UseThreads(0);
    steps.Begin("reference of frame " + std::to_string(frame), kReferenceShare);
    const Frame reference = of_reference.FrameOf(frame);
    const std::vector<float> reference_steps_m = of_reference.StepsOf_m(frame);
    steps.Begin("errors of frame " + std::to_string(frame), kErrorsShare);
    for (std::size_t i = 0; i < results.size(); ++i) {
      if (!results[i].row.is_matched()) continue;
      const SimulatorSpec of_row = ComparedSpec(results[i].row, spec);
      simulator.Use(of_row);
      simulator.Scan(frame, other);
      comparisons[i].Add(reference, other);
      comparisons[i].AddEdges(reference, reference_steps_m, other,
                              StepsWith(of_row, kFoundSteps, frame, simulator));
    }
  }
  std::vector<std::vector<Approach>> approaches =
      MeasureApproaches(plan, of_reference, spec, simulator, steps);
  steps.Begin("scene detail", 0.0);
  MeasureDetail(plan, spec, simulators, results);
  simulator.Use(spec);
  for (std::size_t i = 0; i < results.size(); ++i) {
    std::sort(results[i].times_ms.begin(), results[i].times_ms.end());
    if (results[i].row.is_matched()) {
      results[i].difference.emplace(RowErrors{comparisons[i].Result(), std::move(approaches[i])});
    }
  }
  return results;
}

}  // namespace railcast
