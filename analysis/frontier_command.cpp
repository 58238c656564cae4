#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "analysis/commands.h"
#include "analysis/frontier/frontier_report.h"
#include "analysis/frontier/kept_frontier.h"
#include "analysis/frontier/measure.h"
#include "analysis/report/formats.h"
#include "analysis/report/output.h"
#include "analysis/report/provenance.h"
#include "core/fidelity/choice_report.h"
#include "core/fidelity/sample_frames.h"
#include "core/io/run/scenario_identity.h"
#include "core/io/write_file.h"
#include "core/program/progress_line.h"
#include "core/program/version.h"
#include "railcast/effects.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

// On the way to an object, from where it comes within range to where it is nearest.
constexpr int kNumApproachFrames = 8;
// For numbers of echoes, whose intervals come from the differences between frames.
constexpr int kNumDetailFrames = 24;

struct FrontierOptions {
  std::filesystem::path scenario;
  std::optional<std::string> sensor;  // Which sensor, where the scenario has several.
  std::filesystem::path out;
  int num_frames = 4;
  int num_threads = 1;
  std::string rows = "all";
};

// The rows bring their own effects. The scenario's switches are cleared so that the choice of
// fidelity auto, which the report states, considers every effect.
ScenarioSpec ReadForFrontier(const FrontierOptions& options) {
  ScenarioSpec scenario = PickSensor(ReadScenario(options.scenario), options.sensor);
  scenario.fidelity = Fidelity::kAuto;
  scenario.effects.clear();
  // Echoes of a coarser scene are as many as those of the finest one, but not the same. The rows
  // with scene detail `auto` have simulators of their own.
  scenario.world.detail = SceneDetail::kFull;
  return scenario;
}

// Tells a run from all that would measure something else.
std::string IdentityText(const FrontierPlan& plan, const std::string& scenario_hash) {
  std::string text = "railcast " + ProgramVersion() + ", scenario " + scenario_hash + ", " +
                     NumberText(plan.num_threads) + " threads, rows";
  for (const FrontierRow& row : plan.rows) text += " " + row.name;
  text += ", frames";
  for (const std::uint32_t frame : plan.frames) text += " " + NumberText(frame);
  return text;
}

int RunFrontier(const FrontierOptions& options, const std::string& command_line) {
  CheckReportFolder(options.out, {"frontier.json", "frontier.csv", "frontier.svg", "frontier.png",
                                  "frontier.part"});
  FrontierPlan plan;
  plan.rows = ChooseFrontierRows(options.rows);
  plan.num_threads = options.num_threads;
  const ScenarioSpec scenario = ReadForFrontier(options);
  const auto simulator = MakeSimulator(scenario, options.num_threads);
  plan.frames = SampleFrames(scenario, *simulator, options.num_frames);
  plan.approach_frames = ApproachFrames(scenario, *simulator, kNumApproachFrames);
  plan.detail_frames =
      SpreadFrames(LastFrameOfRun(scenario, *simulator, kNumDetailFrames), kNumDetailFrames);
  // The choice of fidelity takes about a tenth of the time.
  constexpr double kRowsShare = 0.9;
  const std::string scenario_hash = IdentityOf(scenario).scenario_hash;
  const KeptFrontier kept(options.out / "frontier.part", IdentityText(plan, scenario_hash));
  const ProgressLine progress(kRowsShare * KeptShare(plan, kept));
  simulator->UseThreads(0);
  const FidelityChoice choice = ChooseFidelity(*simulator, scenario, [&](double done) {
    progress.Show("what the scene needs", (1.0 - kRowsShare) * done);
  });
  UseChoice(choice, LabelTable(scenario.labels), plan.rows);
  const std::vector<RowResult> results =
      MeasureFrontier(plan, scenario, *simulator, kept, [&](const std::string& what, double done) {
        progress.Show(what, 1.0 - kRowsShare + kRowsShare * done);
      });
  progress.End();
  const FrontierCircumstances circumstances = {
      ProgramVersion(),
      ShownPath(options.scenario),
      scenario.seed,
      MakeComparisonSpec(scenario.lidar.beam, scenario.lidar.range_max_m,
                         LabelTable(scenario.labels), {})
          .match_distance_m,
      ChoiceJson(choice),
      ChoiceText(choice),
      ReportDate(),
      scenario_hash,
      WeatherText(scenario.weather)};
  WriteFileWhole(options.out / "frontier.csv", FrontierCsv(results));
  const Report report =
      MakeFrontierReport(plan, circumstances, LabelTable(scenario.labels), results, command_line);
  EmitReport(report, {options.out, true}, "frontier",
             FrontierJson(plan, circumstances, LabelTable(scenario.labels), results));
  DrawSheet(report.sections.front().charts, report.title, options.out / "frontier");
  kept.Remove();
  if (const std::string busy = BusyText(ConditionsOf(plan, results)); !busy.empty()) {
    std::cout << busy << "\n";
  }
  std::cout << "frontier.csv, .svg, .png in " << ShownPath(options.out) << "\n";
  return kExitSuccess;
}

}  // namespace

void AddFrontier(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<FrontierOptions>();
  ProgramOptions frontier = app.AddCommand("frontier",
                                           "Chart time against accuracy: the rungs, brute force, "
                                           "and the reference; run the same command "
                                           "again to continue an interrupted run");
  frontier.AddOption("SCENARIO", options->scenario, "Scenario file").Required().Check(NonEmpty());
  frontier
      .AddOption("--out", options->out,
                 "Directory for report.html, its charts and tables, and frontier.json, .csv, .svg, "
                 ".png")
      .Required()
      .Check(NonEmpty());
  frontier
      .AddOption("--frames", options->num_frames,
                 "Number of sample frames, spread over the run and where objects are")
      .Check(Whole({1, 1000}))
      .ShowDefault();
  AddThreads(frontier, options->num_threads,
             "Number of threads to measure times with; 0 = all cores");
  frontier.AddOption("--sensor", options->sensor,
                     "Name of the sensor, where the scenario has several");
  frontier
      .AddOption("--rows", options->rows,
                 "Rows of the table to measure, separated by commas, or all")
      .ShowDefault();
  frontier.WhenParsed([&command, options] {
    command = [options](const std::string& line) { return RunFrontier(*options, line); };
  });
}

}  // namespace railcast
