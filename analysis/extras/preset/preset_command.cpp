#include <memory>
#include <string>
#include <vector>

#include "analysis/analysis_extras.h"
#include "analysis/commands.h"
#include "analysis/extras/preset/preset_comparison.h"
#include "analysis/extras/preset/receiver_figures.h"
#include "analysis/report/output.h"
#include "analysis/report/provenance.h"
#include "core/base/error.h"
#include "core/base/parallelism.h"
#include "core/io/recording/source_choice.h"
#include "core/program/version.h"
#include "railcast/io/recording.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

struct PresetOptions {
  std::filesystem::path source;
  SourceChoice choice;
  std::filesystem::path scenario;
  std::string sectors = "all";
  int num_threads = 0;
  ReportOutput output;
};

Sectors SectorsOf(const std::string& name) {
  if (name == "even") return Sectors::kEven;
  return name == "odd" ? Sectors::kOdd : Sectors::kAll;
}

int RunPreset(const PresetOptions& options, const std::string& command_line) {
  CheckReportFolder(options.output.out, {"preset.json"});
  const auto limit = LimitThreads(options.num_threads);
  const std::filesystem::path source = WithChoice({options.source}, options.choice).front();
  const auto recording = OpenRecording(source);
  const RecordingInfo& info = recording->info();
  const std::string name = ShownPath(options.source);
  Report report{.title = "Surfaces and receiver of " + name,
                .command = command_line,
                .facts = {{"Recording", info.kind}}};
  if (!options.scenario.empty()) {
    const ScenarioSpec scenario = PickSensor(ReadScenario(options.scenario), std::nullopt);
    const PresetComparison comparison =
        ComparePreset(*recording, scenario, SectorsOf(options.sectors));
    report = MakePresetReport(comparison, info, scenario, command_line);
  }
  constexpr std::size_t kMostTurns = 12;
  // A comparison has read the recording to its end.
  const std::vector<RecordedFrame> turns =
      WholeTurns(options.scenario.empty() ? *recording : *OpenRecording(source), kMostTurns);
  if (turns.empty()) throw InputError(name + ": must hold a whole turn as a grid (got none)");
  report.sections.push_back(MakeReceiverSection(FindReceiverFigures(turns)));
  AddProvenance({info}, ProgramVersion(), report);
  EmitReport(report, options.output, "preset");
  return kExitSuccess;
}

void AddPreset(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<PresetOptions>();
  ProgramOptions preset = app.AddCommand(
      "preset",
      "Estimate properties of receiver and surfaces from a real sensor's recording, and compare "
      "it with what a scenario's sensor measures on its planes");
  preset
      .AddOption("SOURCE", options->source,
                 "Capture or other recording of a stationary sensor, with a row for each channel")
      .Required()
      .Check(NonEmpty());
  AddSourceChoice(preset, options->choice);
  AddCaptureSensor(preset, options->choice.sensor);
  preset.AddOption("--scenario", options->scenario,
                   "Scenario whose sensor, rung, weather and materials are compared; without it "
                   "the report is of surfaces and receiver alone");
  preset
      .AddOption("--sectors", options->sectors, "Which sectors of 30 deg take part: all, even, odd")
      .Check(Named({"all", "even", "odd"}))
      .ShowDefault();
  AddThreads(preset, options->num_threads);
  AddReportOptions(preset, options->output);
  preset.WhenParsed([&command, options] {
    command = [options](const std::string& line) { return RunPreset(*options, line); };
  });
}

}  // namespace

void AddPreset(AnalysisExtras& extras) {
  extras.commands["preset"] = AddPreset;
}

}  // namespace railcast
