#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/fidelity/choice_report.h"
#include "core/io/run/run_folder.h"
#include "core/io/write_file.h"
#include "core/program/progress_line.h"
#include "core/program/stop_signals.h"
#include "core/scenario/track_limits.h"
#include "generator/commands.h"
#include "generator/run/all_sensors.h"
#include "generator/run/frame_maker.h"
#include "generator/run/make_frames.h"
#include "generator/run/run_options.h"
#include "generator/run/run_plan.h"
#include "generator/sequence/summary.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

struct SequenceOptions {
  std::filesystem::path scenario;
  RunChoices made;
  std::optional<std::uint64_t> seed;              ///< Overrides the scenario's.
  std::optional<std::string> fidelity;            ///< Overrides the scenario's.
  std::optional<std::string> sensor;              ///< Which sensor, if there are several.
  std::optional<std::filesystem::path> commands;  ///< Log of a live run to replay.
  std::optional<std::filesystem::path> summary;   ///< JSON file on the run.
  std::optional<std::filesystem::path> picture;   ///< PNG of its last frame.
  bool is_verbose = false;
};

RunPlan PlanOf(const SequenceOptions& options) {
  const std::string shown = ShownPath(options.scenario);
  ScenarioSpec whole = ReadScenario(options.scenario);
  if (options.seed) whole.seed = *options.seed;
  if (options.fidelity) whole.fidelity = ValueNamed<Fidelity>(*options.fidelity).value();
  const bool has_all = !options.sensor && SensorNames(whole).size() > 1;
  RunPlan plan = PlanRun(has_all ? whole : PickSensor(whole, options.sensor), options.made, shown);
  if (options.commands) UseCommands(*options.commands, whole, plan);
  if (options.is_verbose) std::cerr << "read " << shown << "\n";
  return plan;
}

// Checks that nothing leaves its track meanwhile, and that the vehicle meets nothing.
void CheckJourney(const FrameMaker& maker, const RunPlan& plan) {
  for (std::size_t i = 0; i < plan.sensors.size(); ++i) {
    const auto& [name, scenario, spec] = plan.sensors[i];
    const std::uint32_t last_frame = spec.FrameAt(spec.num_frames - 1);
    maker.CheckStaysOnTracks(i, spec.start_frame, last_frame);
    // A log of commands reproduces what happened, be it a collision. What the vehicle meets does
    // not depend on the sensor.
    if (!spec.commands_jsonl.empty() || i > 0) continue;
    CheckVehicleIsClear(plan.scenario, maker.simulator(i).world(), maker.pattern(i),
                        spec.start_frame, last_frame);
  }
}

// Prints what was made. Returns whether all of it is there.
bool PrintSummaries(const std::optional<std::filesystem::path>& summary,
                    const RunPlan& plan,
                    const std::vector<SequenceResult>& results) {
  std::vector<SummarizedRun> summarized;
  std::string unfinished;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const auto& [name, scenario, spec] = plan.sensors[i];
    std::cerr << ShownLines(MendedText(results[i].changed));
    std::cout << ShownLines(Summary(spec, results[i]));
    summarized.push_back({name, spec, results[i]});
    if (results[i].is_complete) continue;
    if (!unfinished.empty()) unfinished += ", ";
    unfinished += std::to_string(spec.FrameAt(results[i].num_done));
    if (plan.is_in_folders()) unfinished += " of " + ShownLines(name);
  }
  if (summary) WriteNamedFile(*summary, SummaryJson(summarized));
  if (unfinished.empty()) return true;
  std::cerr << "interrupted; the same command continues with frame " << unfinished << "\n";
  return false;
}

int RunSequenceCommand(const SequenceOptions& options) {
  RunPlan plan = PlanOf(options);
  // Now all that is read is known.
  CheckOutputFiles(
      {{"SCENARIO", options.scenario},
       {"--commands", options.commands.value_or("")},
       {"--out", options.made.directory}},
      {{"--summary", options.summary.value_or("")}, {"--picture", options.picture.value_or("")}});
  FrameMaker maker(plan.scenario, options.made.num_threads, plan.sensors.front().spec.isa);
  for (std::size_t i = 0; options.is_verbose && i < maker.num_sensors(); ++i) {
    std::cerr << "made the simulator: " << maker.pattern(i).num_firings() << " firings a frame, "
              << maker.simulator(i).world().objects().size() << " objects, " << plan.commands.size()
              << " commands\n";
  }
  AtPlace(plan.commands_place, [&] { maker.Apply(plan.commands); });
  SetFrames(maker, plan);
  CheckJourney(maker, plan);
  if (plan.is_merged) CheckCanMerge(maker, plan);
  const RunFolders folders(plan);
  // The directory can be resumed however the program ends.
  CatchStopSignals();
  const auto say_choice = [&](const SensorPlan& sensor, const FidelityChoice& choice) {
    if (plan.is_in_folders()) std::cout << ShownLines(sensor.name) << ":\n";
    std::cout << ChoiceText(choice) << std::flush;
  };
  FrameProgress progress;
  std::optional<ProgressLine> merging;
  bool has_all = false;
  const SequenceHooks hooks = {
      {[&](std::uint32_t num_done, std::uint32_t num) { progress.Show(num_done, num); },
       StopRequested},
      [&](const std::vector<SequenceResult>& results) {
        progress.End();
        has_all = PrintSummaries(options.summary, plan, results);
      },
      [&](double done) {
        if (!merging) merging.emplace();
        merging->Show("merged clouds", done);
      }};
  if (!ChooseFidelities(maker, say_choice, hooks, plan)) {
    std::cerr << "interrupted before the first frame\n";
    return kExitInterrupted;
  }
  UseCertificates(maker, plan);
  const PlanResult result = MakeFrames(maker, plan, folders, hooks);
  if (merging) merging->End();
  if (!has_all) return kExitInterrupted;
  if (result.is_complete && options.picture) {
    const SequenceSpec& spec = plan.sensors.front().spec;
    WriteNamedFile(*options.picture, PictureOfFrame(plan, spec.FrameAt(spec.num_frames - 1),
                                                    options.made.num_threads));
  }
  if (result.is_complete) return kExitSuccess;
  std::cerr << "interrupted; the same command merges the clouds\n";
  return kExitInterrupted;
}

}  // namespace

void AddSequence(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<SequenceOptions>();
  ProgramOptions sequence = app.AddCommand(
      "sequence",
      "Write labelled frames to files; run the same command again to continue an interrupted run");
  sequence.AddOption("SCENARIO", options->scenario, "Scenario file").Required().Check(NonEmpty());
  sequence.AddOption("--out", options->made.directory, "Directory to write the frames to")
      .Required()
      .Check(NonEmpty());
  sequence
      .AddOption("--frames", options->made.num_frames,
                 "Number of frames of the first sensor; the other sensors cover the same time")
      .Check(Whole({1, kMaxFrame}))
      .ShowDefault();
  sequence.AddOption("--start-frame", options->made.start_frame, "Number of the first frame")
      .Check(Whole({0, kMaxFrame}))
      .ShowDefault();
  sequence
      .AddOption("--stride", options->made.stride,
                 "Every how many-th of the scenario's frames to make; 1 = all")
      .Check(Whole({1, kMaxFrame}))
      .ShowDefault();
  AddRunChoices(sequence, options->made);
  sequence.AddOption("--seed", options->seed, "Seed to use instead of the scenario's")
      .Check(Whole({}));
  sequence.AddOption("--fidelity", options->fidelity, "Fidelity to use instead of the scenario's")
      .Check(Named(NamesOf<Fidelity>()));
  sequence.AddOption(
      "--sensor", options->sensor,
      "Name of the only sensor to simulate; without it, each of several sensors gets a "
      "folder of its name in --out");
  sequence
      .AddOption(
          "--commands", options->commands,
          "Command log of a live run to replay; with that run's scenario it reproduces its frames")
      .Check(NonEmpty());
  AddSummaryFile(sequence, options->summary);
  sequence
      .AddOption("--picture", options->picture,
                 "PNG file to draw the last frame into: its points in the colours of their "
                 "labels, over the image of the scenario's camera, or of a camera at the sensor "
                 "if it has none")
      .Check(NonEmpty());
  sequence.Footer(
      "Exit status: 0 success, 1 bad input or failed run, 2 usage, 130 interrupted (the same\n"
      "command continues).");
  sequence.AddFlag("-v,--verbose", options->is_verbose, "Print details of each step");
  sequence.WhenParsed([&command, options] {
    CheckFields(options->made.fields);
    command = [options](const std::string&) { return RunSequenceCommand(*options); };
  });
}

}  // namespace railcast
