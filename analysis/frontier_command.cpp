#include <iostream>

#include "analysis/commands.h"
#include "analysis/frontier/chart.h"
#include "analysis/frontier/files.h"
#include "analysis/frontier/measure.h"
#include "analysis/frontier/pareto.h"
#include "analysis/frontier/table.h"
#include "analysis/progress_line.h"
#include "core/fidelity/choice_report.h"
#include "core/fidelity/sample_frames.h"
#include "core/io/write_file.h"
#include "core/scenario/effects.h"
#include "core/scenario/scenario.h"

namespace railcast {
namespace {

// The rows bring their own effects; what is not needed is asked of all there are.
ScenarioSpec ReadForFrontier(const FrontierOptions& options) {
  ScenarioSpec scenario = PickSensor(ReadScenario(options.scenario), options.sensor);
  scenario.fidelity = kAutoFidelity;
  scenario.effects.clear();
  return scenario;
}

std::string Head(const FrontierPlan& plan) {
  return std::to_string(plan.frames.size()) + " frames, " +
         (plan.num_threads == 0 ? "all" : std::to_string(plan.num_threads)) +
         " thread(s), errors against " + std::to_string(plan.yardstick_rays) + " sub-rays a beam";
}

}  // namespace

int FrontierCommand(const FrontierOptions& options) {
  FrontierPlan plan;
  plan.rows = ChooseFrontierRows(options.rows);
  plan.num_threads = options.num_threads;
  const ScenarioSpec scenario = ReadForFrontier(options);
  const auto simulator = MakeSimulator(scenario, options.num_threads);
  constexpr double kFrameSpacing_s = 1.0;
  plan.frames = SampleFrames(scenario, *simulator, options.num_frames, kFrameSpacing_s);
  std::filesystem::create_directories(options.out);
  // The choice takes about a tenth of the time.
  constexpr double kRowsShare = 0.9;
  const ProgressLine progress;
  const std::vector<RowResult> results = MeasureFrontier(
      plan, scenario, *simulator,
      [&](const std::string& what, double done) { progress.Show(what, kRowsShare * done); });
  const FidelityChoice choice = ChooseFidelity(*simulator, scenario, [&](double done) {
    progress.Show("what the scene needs", kRowsShare + (1.0 - kRowsShare) * done);
  });
  progress.End();
  const std::string head = options.scenario.string() + ": " + Head(plan);
  std::cout << head << "\n"
            << FrontierTable(results) << DefeatsText(FindDefeats(results))
            << ChoiceText(choice, scenario.tolerance) << std::flush;

  const FrontierCircumstances circumstances = {
      RAILCAST_VERSION, options.scenario.string(), scenario.seed,
      MakeComparisonSpec(scenario.lidar.beam, scenario.lidar.range_max_m,
                         LabelTable(scenario.labels))
          .match_distance_m,
      ChoiceJson(choice, scenario.tolerance)};
  WriteFileWhole(options.out / "frontier.json",
                 FrontierJson(plan, circumstances, LabelTable(scenario.labels), results));
  WriteFileWhole(options.out / "frontier.csv", FrontierCsv(results));
  WriteFileWhole(options.out / "frontier.gnuplot", ChartScript(results, head));
  DrawChart(options.out / "frontier.gnuplot", options.out / "frontier");
  std::cout << "frontier.json, .csv, .svg, .png in " << options.out.string() << "\n";
  return kExitSuccess;
}

}  // namespace railcast
