#include "analysis/frontier/measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/base/error.h"
#include "core/fidelity/yardstick.h"

namespace railcast {
namespace {

constexpr int kScansPerRound = 3;
// A row as slow as this is scanned once a round, without a scan before to warm the caches.
constexpr double kSlow_ms = 250.0;
// A row needs no more than this in all, beyond one scan of each frame.
constexpr double kEnough_ms = 10'000.0;

double Time_ms(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

class Stopwatch {
 public:
  Stopwatch(const SimulatorSpec& spec, Simulator& simulator) : spec_(spec), simulator_(simulator) {}

  // One round of all rows on one frame.
  void Round(std::uint32_t frame,
             const std::function<void()>& raw_trace,
             int round,
             std::vector<RowResult>& results) {
    for (RowResult& result : results) {
      const bool is_raw = result.row.group == RowGroup::kRawTrace;
      if (!is_raw) simulator_.Use(SpecOfRow(result.row, spec_));
      const std::function<void()> scan = [&] { simulator_.Scan(frame, frame_); };
      TimeRow(is_raw ? raw_trace : scan, round, result.times_ms);
    }
  }

 private:
  static void TimeRow(const std::function<void()>& work, int round, std::vector<double>& times_ms) {
    double total_ms = 0.0;
    for (const double time_ms : times_ms) total_ms += time_ms;
    if (round > 0 && total_ms > kEnough_ms) return;
    const bool is_slow = !times_ms.empty() && times_ms.back() > kSlow_ms;
    if (!is_slow) {
      const double first_ms = Time_ms(work);  // Caches are another row's.
      if (first_ms > kSlow_ms) {
        times_ms.push_back(first_ms);
        return;
      }
    }
    for (int i = 0; i < (is_slow ? 1 : kScansPerRound); ++i) times_ms.push_back(Time_ms(work));
  }

  const SimulatorSpec& spec_;
  Simulator& simulator_;
  Frame frame_;
};

// Errors are of all echoes, and before range noise.
SimulatorSpec ComparedSpec(const FrontierRow& row, const SimulatorSpec& scenario) {
  SimulatorSpec spec = SpecOfRow(row, scenario);
  spec.effects = WithoutRangeErrors(spec.effects);
  spec.receiver.return_mode = "triple";
  return spec;
}

}  // namespace

double RowResult::TimeQuantile_ms(double q) const {
  Check(!times_ms.empty(), "a row has been timed");
  const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(times_ms.size())));
  return times_ms[std::max<std::size_t>(rank, 1) - 1];
}

std::vector<RowResult> MeasureFrontier(const FrontierPlan& plan,
                                       const ScenarioSpec& scenario,
                                       Simulator& simulator,
                                       const FrontierProgress& on_progress) {
  const SimulatorSpec spec = simulator.spec();
  std::vector<RowResult> results;
  for (const FrontierRow& row : plan.rows) results.push_back({row, {}, {}, {}});
  const ComparisonSpec comparison = MakeComparisonSpec(
      scenario.lidar.beam, scenario.lidar.range_max_m, LabelTable(scenario.labels));
  std::vector<FrameComparison> comparisons(results.size(), FrameComparison(comparison));
  const FrontierRow yardstick{"yardstick", RowGroup::kReference, YardstickEffects(),
                              plan.yardstick_rays};
  Stopwatch stopwatch(spec, simulator);
  Frame reference;
  Frame other;
  double done = 0.0;
  const auto advance = [&](const std::string& what, double steps) {
    on_progress(what, done);
    done += steps / static_cast<double>(plan.frames.size());
  };
  for (const std::uint32_t frame : plan.frames) {
    simulator.UseThreads(plan.num_threads);
    const std::function<void()> raw_trace = simulator.MakeRawTrace(frame);
    for (int round = 0; round < plan.num_rounds; ++round) {
      advance("timing frame " + std::to_string(frame), 0.5 / plan.num_rounds);
      stopwatch.Round(frame, raw_trace, round, results);
    }
    simulator.UseThreads(0);
    advance("reference of frame " + std::to_string(frame), 0.4);
    simulator.Use(ComparedSpec(yardstick, spec));
    simulator.Scan(frame, reference);
    advance("errors of frame " + std::to_string(frame), 0.1);
    for (std::size_t i = 0; i < results.size(); ++i) {
      if (results[i].row.group == RowGroup::kRawTrace) continue;
      simulator.Use(ComparedSpec(results[i].row, spec));
      simulator.Scan(frame, other);
      comparisons[i].Add(reference, other);
    }
  }
  simulator.Use(spec);
  for (std::size_t i = 0; i < results.size(); ++i) {
    std::sort(results[i].times_ms.begin(), results[i].times_ms.end());
    if (results[i].row.group != RowGroup::kRawTrace) {
      results[i].difference = comparisons[i].Result();
    }
    results[i].ratio = results[i].p50_ms() / results.front().p50_ms();
  }
  return results;
}

}  // namespace railcast
