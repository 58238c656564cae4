#include <iostream>

#include "analysis/commands.h"
#include "analysis/frontier/measure.h"
#include "analysis/frontier/table.h"
#include "analysis/progress_line.h"
#include "core/fidelity/sample_frames.h"
#include "core/scenario/scenario.h"

namespace railcast {

int FrontierCommand(const FrontierOptions& options) {
  FrontierPlan plan;
  plan.rows = ChooseFrontierRows(options.rows);
  plan.num_threads = options.num_threads;
  const ScenarioSpec scenario = ReadScenario(options.scenario);
  const auto simulator = MakeSimulator(scenario, options.num_threads);
  plan.frames = SampleFrames(simulator->pattern(), options.num_frames);
  ProgressLine progress;
  const std::vector<RowResult> results =
      MeasureFrontier(plan, scenario, *simulator,
                      [&](const std::string& what, double done) { progress.Show(what, done); });
  progress.End();
  std::cout << options.scenario.string() << ": " << plan.frames.size() << " frames, "
            << (plan.num_threads == 0 ? "all" : std::to_string(plan.num_threads))
            << " thread(s), against " << plan.yardstick_rays << " sub-rays a beam\n"
            << FrontierTable(results);
  return kExitSuccess;
}

}  // namespace railcast
