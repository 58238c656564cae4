#include "analysis/frontier/measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "analysis/frontier/row_simulators.h"
#include "core/base/error.h"
#include "core/fidelity/beam_steps.h"
#include "core/fidelity/yardstick.h"

namespace railcast {
namespace {

constexpr int kScansPerRound = 3;
// A row as slow as this is scanned once per round: warm caches would change little.
constexpr double kSlow_ms = 250.0;
// Total time that suffices for a row, beyond one scan of each frame.
constexpr double kEnough_ms = 10'000.0;

double Time_ms(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

class Stopwatch {
 public:
  Stopwatch(const SimulatorSpec& spec, RowSimulators& simulators)
      : spec_(spec), simulators_(simulators) {}

  // One round of all rows on one frame.
  // @pre The first row is the raw trace.
  void Round(std::uint32_t frame,
             const std::function<void()>& raw_trace,
             bool is_first_round,
             std::vector<RowResult>& results) {
    double raw_ms = 0.0;
    for (RowResult& result : results) {
      const bool is_raw = result.row.group == RowGroup::kRawTrace;
      Simulator& simulator = simulators_.Of(result.row);
      if (!is_raw) simulator.Use(SpecOfRow(result.row, spec_));
      const std::function<void()> scan = [&] { simulator.Scan(frame, frame_); };
      const bool has_enough =
          std::accumulate(result.times_ms.begin(), result.times_ms.end(), 0.0) > kEnough_ms;
      if (has_enough && !is_first_round) continue;
      std::vector<double> times_ms = TimesOf(is_raw ? raw_trace : scan);
      result.times_ms.insert(result.times_ms.end(), times_ms.begin(), times_ms.end());
      std::sort(times_ms.begin(), times_ms.end());
      const double median_ms = times_ms[times_ms.size() / 2];
      if (is_raw) raw_ms = median_ms;
      result.ratios.push_back(median_ms / raw_ms);
    }
  }

 private:
  static std::vector<double> TimesOf(const std::function<void()>& work) {
    const double first_ms = Time_ms(work);  // The caches still hold another row's data.
    if (first_ms > kSlow_ms) return {first_ms};
    std::vector<double> times_ms;
    for (int i = 0; i < kScansPerRound; ++i) times_ms.push_back(Time_ms(work));
    return times_ms;
  }

  const SimulatorSpec& spec_;
  RowSimulators& simulators_;
  Frame frame_;
};

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

// The points of each object on the frames on the way to it, for each row.
std::vector<std::vector<Approach>> MeasureApproaches(const FrontierPlan& plan,
                                                     const FrontierRow& yardstick,
                                                     const SimulatorSpec& spec,
                                                     Simulator& simulator) {
  std::vector<std::vector<Approach>> approaches(plan.rows.size(), ApproachesIn(simulator.world()));
  Frame reference;
  Frame other;
  for (const std::uint32_t frame : plan.approach_frames) {
    simulator.Use(ComparedSpec(yardstick, spec));
    simulator.Scan(frame, reference);
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
  Check(!times_ms.empty(), "a row has been timed");
  const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(times_ms.size())));
  return times_ms[std::max<std::size_t>(rank, 1) - 1];
}

double RowResult::ratio() const {
  std::vector<double> sorted = ratios;
  std::sort(sorted.begin(), sorted.end());
  return sorted[sorted.size() / 2];
}

std::vector<RowResult> MeasureFrontier(const FrontierPlan& plan,
                                       const ScenarioSpec& scenario,
                                       Simulator& simulator,
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
  RowSimulators simulators(scenario, simulator, plan.rows);
  Stopwatch stopwatch(spec, simulators);
  Frame reference;
  Frame other;
  double done = 0.0;
  const auto advance = [&](const std::string& what, double steps) {
    on_progress(what, done);
    done += steps / static_cast<double>(plan.frames.size());
  };
  for (const std::uint32_t frame : plan.frames) {
    simulators.UseThreads(plan.num_threads);
    simulators.BuildWindows(frame);
    const std::function<void()> raw_trace = simulator.MakeRawTrace(frame);
    for (int round = 0; round < plan.num_rounds; ++round) {
      advance("timing frame " + std::to_string(frame), 0.5 / plan.num_rounds);
      stopwatch.Round(frame, raw_trace, round == 0, results);
    }
    simulators.UseThreads(0);
    advance("reference of frame " + std::to_string(frame), 0.4);
    const SimulatorSpec of_yardstick = ComparedSpec(yardstick, spec);
    simulator.Use(of_yardstick);
    simulator.Scan(frame, reference);
    const std::vector<float> reference_steps_m =
        StepsWith(of_yardstick, kReferenceSteps, frame, simulator);
    advance("errors of frame " + std::to_string(frame), 0.1);
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
  on_progress("detection distances", done);
  std::vector<std::vector<Approach>> approaches =
      MeasureApproaches(plan, yardstick, spec, simulator);
  on_progress("scene detail", done);
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
