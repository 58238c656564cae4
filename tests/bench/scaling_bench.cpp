// Measures what a frame of each of several scenarios costs, beside the raw trace of the same rays,
// in turns in one process. Prints tab-separated values, a line for each scenario and number of
// threads. scripts/dev/growth.py draws them.
//
//   railcast-measure scaling SCENARIO... [--turns N] [--threads LIST]
//
// Each turn traces and makes frame 0 twice, of which the second time counts; the least over the
// turns is printed, which other programs on the machine disturb least, and also the least time that
// the processor spent on it. Times of a scenario with several sensors are those of all of them.
// Build time and memory come from a process of their own for each line.
#include <algorithm>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/program/command_line.h"
#include "railcast/scenario.h"
#include "tests/bench/measurements.h"
#include "tests/bench/scene_cost.h"

namespace railcast {
namespace {

struct ScalingOptions {
  std::vector<std::string> scenarios;
  std::vector<int> num_threads = {0};
  int num_turns = 20;
};

/// The least over the turns.
struct LeastTime {
  double wall_ms = std::numeric_limits<double>::infinity();
  double cpu_ms = std::numeric_limits<double>::infinity();  ///< Sum over the threads.
};

/// A line of the output.
struct ScalingRow {
  std::string file;
  ScenarioSpec scenario;
  int num_threads{};
  BuildCost cost{};
  std::unique_ptr<FrameMaker> maker{};
  std::function<void()> raw_trace{};
  LeastTime raw{};
  LeastTime frame{};
};

void KeepLeast(const std::function<void()>& work, LeastTime& least) {
  work();  // Warms the caches, because the rows before it ran on other memory.
  const double begin_ms = CpuTime_ms();
  least.wall_ms = std::min(least.wall_ms, TimeOf_ms(work));
  least.cpu_ms = std::min(least.cpu_ms, CpuTime_ms() - begin_ms);
}

int RunScaling(const ScalingOptions& options) {
  std::vector<ScalingRow> rows;
  for (const std::string& file : options.scenarios) {
    const ScenarioSpec scenario = ReadScenario(file);
    for (const int num_threads : options.num_threads) {
      rows.push_back({file, scenario, num_threads, BuildInAProcess(scenario, num_threads)});
    }
  }
  for (ScalingRow& row : rows) {
    row.maker = std::make_unique<FrameMaker>(row.scenario, row.num_threads);
    row.maker->Make(0);
    row.raw_trace = row.maker->MakeRawTrace();
  }
  WaitUntilIdle();
  for (int turn = 0; turn < options.num_turns; ++turn) {
    for (ScalingRow& row : rows) {
      KeepLeast(row.raw_trace, row.raw);
      KeepLeast([&] { row.maker->Make(0); }, row.frame);
    }
  }
  std::printf(
      "scenario\tthreads\tsensors\tobjects\tfirings\tpoints\ttriangles\tinstances\tbuild_s\t"
      "memory_mb\traw_ms\tframe_ms\traw_cpu_ms\tframe_cpu_ms\n");
  for (const ScalingRow& row : rows) {
    const SceneSize size = SizeOf(row.scenario, row.maker->world());
    std::printf("%s\t%d\t%zu\t%zu\t%zu\t%zu\t%zu\t%zu\t%.3f\t%.1f\t%.4f\t%.4f\t%.4f\t%.4f\n",
                row.file.c_str(), row.num_threads, SensorNames(row.scenario).size(),
                row.scenario.world.objects.size(), row.maker->num_firings(), row.cost.num_points,
                size.num_triangles, size.num_instances, row.cost.build_s, row.cost.memory_mb,
                row.raw.wall_ms, row.frame.wall_ms, row.raw.cpu_ms, row.frame.cpu_ms);
  }
  return kExitSuccess;
}

}  // namespace

void AddScaling(ProgramOptions& app, ProgramCommand& command) {
  ProgramOptions scaling =
      app.AddCommand("scaling", "Measure what a frame of each of several scenarios costs");
  const auto options = std::make_shared<ScalingOptions>();
  scaling.AddOption("SCENARIO", options->scenarios, "Scenario files").Required().Check(NonEmpty());
  scaling.AddOption("--turns", options->num_turns, "Turns that each line takes")
      .Check(Whole({1, 1'000'000}))
      .ShowDefault();
  scaling
      .AddOption("--threads", options->num_threads,
                 "Numbers of threads, separated by commas; 0 = all cores")
      .SeparatedBy(',')
      .Check(Whole({0, 1024}));
  scaling.WhenParsed([options, &command] {
    command = [options](const std::string&) { return RunScaling(*options); };
  });
}

}  // namespace railcast
