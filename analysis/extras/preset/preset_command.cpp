#include <memory>
#include <string>

#include "analysis/analysis_extras.h"
#include "analysis/commands.h"
#include "analysis/extras/preset/preset_comparison.h"
#include "analysis/report/output.h"
#include "analysis/report/provenance.h"
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
  const tbb::global_control limit = LimitThreads(options.num_threads);
  const ScenarioSpec scenario = PickSensor(ReadScenario(options.scenario), std::nullopt);
  const auto recording = OpenRecording(WithChoice({options.source}, options.choice).front());
  const PresetComparison comparison =
      ComparePreset(*recording, scenario, SectorsOf(options.sectors));
  const RecordingInfo& info = recording->info();
  Report report = MakePresetReport(comparison, info, scenario, command_line);
  AddProvenance({info}, ProgramVersion(), report);
  EmitReport(report, options.output, "preset");
  return kExitSuccess;
}

void AddPreset(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<PresetOptions>();
  ProgramOptions preset = app.AddCommand(
      "preset",
      "Compare a real sensor's recording with what a scenario's sensor measures on its planes");
  preset
      .AddOption("SOURCE", options->source,
                 "Capture or other recording of a sensor that stands, as grids")
      .Required();
  AddSourceChoice(preset, options->choice);
  AddCaptureSensor(preset, options->choice.sensor);
  preset
      .AddOption("--scenario", options->scenario,
                 "Scenario whose sensor, rung, weather and materials are compared")
      .Required();
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
