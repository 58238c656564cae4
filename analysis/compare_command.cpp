#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "analysis/commands.h"
#include "analysis/compare/ablation.h"
#include "analysis/compare/compare_report.h"
#include "analysis/compare/comparison.h"
#include "analysis/report/output.h"
#include "analysis/report/provenance.h"
#include "core/base/join.h"
#include "core/base/parallelism.h"
#include "core/fidelity/sample_frames.h"
#include "core/io/recording/source_choice.h"
#include "core/io/run/run_folder.h"
#include "core/io/run/scenario_identity.h"
#include "core/program/progress_line.h"
#include "core/program/version.h"
#include "railcast/effects.h"
#include "railcast/io/recording.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

struct CompareOptions {
  std::vector<std::filesystem::path> sources;  // Recordings A and B.
  SourceChoice choice;
  std::optional<Pairing> pairing;
  std::string distances = "0.05,0.1,0.2,0.5";
  bool registers = false;
  int num_threads = 0;
  ReportOutput output;
  // Options of an ablation.
  std::filesystem::path scenario;
  int num_frames = 10;
  std::optional<std::uint64_t> seed;
  std::optional<std::string> sensor;
  bool takes_all_effects = false;
};

// Parses a list such as "0.05,0.1".
std::vector<double> ParseDistances(std::string_view text) {
  std::vector<double> distances_m;
  while (true) {
    const std::size_t comma = text.find(',');
    const std::string_view word = text.substr(0, comma);
    const auto distance_m = ParseNumber<double>(word);
    if (!distance_m || !(*distance_m > 0.0)) {
      throw InputError("--distances: must be > 0 (got " + ShownText(word) + ")");
    }
    distances_m.push_back(*distance_m);
    if (comma == std::string_view::npos) return distances_m;
    text.remove_prefix(comma + 1);
  }
}

int RunPairs(const CompareOptions& options, const std::string& command_line) {
  Comparison comparison(ParseDistances(options.distances), options.registers);
  SourceChoice choice = options.choice;
  choice.sensor = options.sensor.value_or("");
  const auto sources = WithChoice(options.sources, choice);
  const auto a = OpenRecording(sources[0]);
  const auto b = OpenRecording(sources[1]);
  FramePairs pairs(*a, *b, options.pairing);
  const ProgressLine progress;
  const std::size_t num_frames = a->info().num_frames.value_or(0);  // 0 if not known.
  PatchPairs patches;
  CompareAll(pairs, comparison, patches, [&](std::uint64_t num_frames_a) {
    if (num_frames == 0) return;
    progress.Show("pairs", static_cast<double>(num_frames_a) / static_cast<double>(num_frames));
  });
  progress.End();
  if (comparison.num_pairs() == 0) {
    throw InputError(ShownPath(options.sources[1]) + ": must have a frame that pairs with one of " +
                     ShownPath(options.sources[0]) + " by " + PairingName(pairs.pairing()) +
                     "; see --pair (got none)");
  }
  Report report = MakeCompareReport(comparison, pairs, a->info(), b->info(), command_line);
  const Separability told = SeparabilityOf(patches);
  report.headlines.push_back({"AUC of the classifier", "", told.area});
  report.sections.push_back(MakeSeparabilitySection(patches, told));
  AddProvenance({a->info(), b->info()}, ProgramVersion(), report);
  EmitReport(report, options.output, "compare");
  return kExitSuccess;
}

Report AblateSensor(const CompareOptions& options,
                    const ScenarioSpec& scenario,
                    Simulator& simulator,
                    const std::string& command_line) {
  const std::vector<std::uint32_t> frames = SampleFrames(scenario, simulator, options.num_frames);
  const ProgressLine progress;
  const std::vector<EffectStudy> studies = Ablate(
      simulator, frames, ParseDistances(options.distances),
      [&](const std::string& what, double done) { progress.Show(what, done); },
      options.takes_all_effects ? StudyScope::kAll : StudyScope::kCompatible);
  progress.End();
  Facts facts = {
      {"Scenario", ShownPath(options.scenario)},
      {"Fidelity", scenario.fidelity == Fidelity::kAuto ? "auto, studied as footprint"
                                                        : std::string(NameOf(scenario.fidelity))},
      {"Frames", Join(frames, ", ", NumberText<std::uint32_t>) +
                     ": spread over the run and where objects are"},
      {"Seed", std::to_string(scenario.seed)},
      {"Scenario hash", IdentityOf(scenario).scenario_hash},
      {"Weather", WeatherText(scenario.weather)}};
  for (auto& fact : MakerFacts(ProgramVersion())) facts.push_back(std::move(fact));
  return MakeAblationReport(studies, "Effects of " + ShownPath(options.scenario.stem()), facts,
                            command_line);
}

int RunAblation(const CompareOptions& options, const std::string& command_line) {
  static_cast<void>(ParseDistances(options.distances));
  ScenarioSpec scenario = ReadScenario(options.scenario);
  if (options.sensor) scenario = PickSensor(scenario, options.sensor);
  if (options.seed) scenario.seed = *options.seed;
  const std::vector<std::string> names = SensorNames(scenario);
  if (names.size() > 1 && !options.output.out.empty()) RefuseLinks(options.output.out, names);
  const auto simulators = MakeSimulators(scenario, options.num_threads);
  // Several reports are one JSON array.
  const bool is_array = names.size() > 1 && options.output.is_json;
  for (std::size_t i = 0; i < simulators.size(); ++i) {
    if (is_array) std::cout << (i == 0 ? "[" : ",");
    ReportOutput output = options.output;
    if (simulators.size() > 1 && !output.out.empty()) output.out /= names[i];
    const ScenarioSpec picked = simulators.size() > 1 ? PickSensor(scenario, names[i]) : scenario;
    EmitReport(AblateSensor(options, picked, *simulators[i], command_line), output, "ablation");
  }
  if (is_array) std::cout << "]\n";
  return kExitSuccess;
}

int RunCompare(const CompareOptions& options, const std::string& command_line) {
  CheckReportFolder(options.output.out,
                    {options.scenario.empty() ? "compare.json" : "ablation.json"});
  const auto limit = LimitThreads(options.num_threads);
  return options.scenario.empty() ? RunPairs(options, command_line)
                                  : RunAblation(options, command_line);
}

void AddAblationOptions(ProgramOptions& compare, CompareOptions& options) {
  const Option ablate = compare
                            .AddOption("--ablate", options.scenario,
                                       "Scenario file, instead of two recordings: what each "
                                       "of its effects changes, beam by beam")
                            .Check(NonEmpty());
  compare
      .AddOption("--frames", options.num_frames,
                 "Number of sample frames, spread over the run and where objects are")
      .Check(Whole({1, 1000}))
      .ShowDefault()
      .Needs(ablate);
  compare.AddOption("--seed", options.seed, "Seed to use instead of the scenario's")
      .Check(Whole({}))
      .Needs(ablate);
  compare.AddOption(
      "--sensor", options.sensor,
      "Name of one of a scenario's sensors; default: all, with a report for each in OUT/NAME. "
      "Required for captures that hold several sensors: ADDRESS or ADDRESS:PORT of one");
  compare
      .AddFlag("--all-effects", options.takes_all_effects,
               "Also study effects that exclude those of the scenario, each on the first rung "
               "that has it")
      .Needs(ablate);
}

}  // namespace

void AddCompare(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<CompareOptions>();
  ProgramOptions compare = app.AddCommand(
      "compare",
      "Measure how far two recordings are apart, or what each effect of a scenario changes");
  compare
      .AddOption("RECORDINGS", options->sources,
                 "Two recordings to compare, the first the reference: each a sequence directory, a "
                 ".pcd or .ply file, a directory of such files, a .pcap capture or a bag of ROS 2")
      .Check(NonEmpty());
  AddSourceChoice(compare, options->choice);
  compare
      .AddText(
          "--pair",
          [options](const std::string& name) {
            options->pairing = name == "stamp" ? Pairing::kStamp : Pairing::kIndex;
          },
          "How to pair frames: by stamp (the nearest within half a period) or by index; default: "
          "by stamp where both recordings have stamps")
      .Check(Named({"stamp", "index"}));
  compare
      .AddOption("--distances", options->distances,
                 "Distances in m, separated by commas, within which a point counts as found, "
                 "for precision, recall and F-score")
      .ShowDefault();
  compare.AddFlag("--register", options->registers,
                  "First register each cloud of the second recording with its partner, starting "
                  "from its recorded pose, and report how far it moved and the residual");
  AddThreads(compare, options->num_threads);
  AddAblationOptions(compare, *options);
  AddReportOptions(compare, options->output);
  compare.WhenParsed([&command, options] {
    const bool is_ablation = !options->scenario.empty();
    if (options->sources.size() != (is_ablation ? 0 : 2)) {
      FailUsage("compare", "takes two recordings, or --ablate SCENARIO");
    }
    if (is_ablation && !options->choice.topic.empty()) {
      FailUsage("--topic", "applies to two recordings only");
    }
    if (is_ablation && !options->choice.frame_id.empty()) {
      FailUsage("--frame-id", "applies to two recordings only");
    }
    if (is_ablation && !options->choice.kitti_columns.empty()) {
      FailUsage("--kitti-columns", "applies to two recordings only");
    }
    if (is_ablation && options->pairing) {
      FailUsage("--pair", "applies to two recordings only");
    }
    if (is_ablation && options->registers) {
      FailUsage("--register", "applies to two recordings only");
    }
    command = [options](const std::string& line) { return RunCompare(*options, line); };
  });
}

}  // namespace railcast
