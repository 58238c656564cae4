#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/attempt.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/fidelity/choice_report.h"
#include "core/io/merged_files.h"
#include "core/io/scenario_identity.h"
#include "core/io/sensor_folders.h"
#include "core/io/write_file.h"
#include "core/program/progress_line.h"
#include "core/scenario/command_log.h"
#include "core/scenario/vehicle_clearance.h"
#include "generator/commands.h"
#include "generator/run/frame_maker.h"
#include "generator/run/make_frames.h"
#include "generator/run/merged_clouds.h"
#include "generator/run/run_options.h"
#include "generator/run/run_plan.h"
#include "generator/run/stop_signal.h"
#include "generator/run/stopping.h"
#include "generator/run/track_limits.h"
#include "generator/sequence/make_sequences.h"
#include "generator/sequence/scenario_sequence.h"
#include "generator/sequence/summary.h"
#include "railcast/camera.h"
#include "railcast/effects.h"
#include "railcast/io/cloud_files.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

struct SequenceOptions {
  std::filesystem::path scenario;
  SequenceChoices made;
  std::optional<std::uint64_t> seed;              ///< Overrides the scenario's.
  std::optional<std::string> fidelity;            ///< Overrides the scenario's.
  std::optional<std::string> sensor;              ///< Which sensor, if there are several.
  std::optional<std::filesystem::path> commands;  ///< Log of a live run to replay.
  std::optional<std::filesystem::path> summary;   ///< JSON file on the run.
  int num_threads = 0;                            ///< 0 = all cores.
  bool is_merged = false;                         ///< Whether sensors' clouds are merged, too.
  bool is_verbose = false;
};

// The whole scenario, to which a log may belong, and the sequences of its sensors or of one.
struct Runs {
  ScenarioSpec whole;
  std::vector<SensorRun> sensors;
  bool is_in_folders{};  ///< Whether each sensor's sequence is in a folder of its own.

  /// The scenario that is simulated.
  [[nodiscard]] const ScenarioSpec& scenario() const {
    return is_in_folders ? whole : sensors.front().scenario;
  }
};

Runs ReadForSequence(const SequenceOptions& options) {
  ScenarioSpec scenario = ReadScenario(options.scenario);
  if (options.seed) scenario.seed = *options.seed;
  if (options.fidelity) scenario.fidelity = ValueNamed<Fidelity>(*options.fidelity).value();
  CheckOutputSuits(options.made.format, scenario, ShownPath(options.scenario));
  Runs runs;
  runs.is_in_folders = !options.sensor && SensorNames(scenario).size() > 1;
  runs.sensors = SensorRunsOf(runs.is_in_folders ? scenario : PickSensor(scenario, options.sensor),
                              options.made);
  if (runs.is_in_folders) RefuseOtherFiles(options.made.directory, runs.sensors);
  runs.whole = std::move(scenario);
  return runs;
}

// Returns the commands of the log since its last reset. The log may belong to all the scenario's
// sensors or to the one that is simulated alone.
CommandLog ReadLog(const SequenceOptions& options, const Runs& runs) {
  CommandLog log;
  if (!options.commands) return log;
  log = ReadCommandLog(*options.commands);
  const std::string whole = IdentityOf(runs.whole).scenario_hash;
  if (log.scenario_xxh3 != whole &&
      log.scenario_xxh3 != IdentityOf(runs.scenario()).scenario_hash) {
    throw InputError(ShownPath(*options.commands) +
                     ": must be the log of this scenario with this --seed and --fidelity, " +
                     whole + " (got that of " + log.scenario_xxh3 + ")");
  }
  // Makes logs of all sensors and of this one alone give the same run.
  log.scenario_xxh3 = whole;
  return log;
}

std::uint32_t LastFrameOf(const SequenceSpec& spec, const ScanPattern& pattern) {
  constexpr std::uint64_t kMost = 2 * kMaxFrame;
  const std::uint64_t last =
      spec.start_frame + std::uint64_t{spec.num_frames - 1} * std::uint64_t{spec.stride};
  if (last > kMost) {
    throw InputError("--start-frame, --frames, --stride: must lead to no frame after " +
                     std::to_string(kMost) + " (got frame " + std::to_string(last) + ")");
  }
  const auto last_frame = static_cast<std::uint32_t>(last);
  CheckHasStamp("--start-frame, --frames", pattern, last_frame);
  return last_frame;
}

class ProgressDisplay {
 public:
  void Show(std::uint32_t num_done, std::uint32_t num_frames) {
    if (!num_resumed_) {
      num_resumed_ = num_done;
      begin_ = std::chrono::steady_clock::now();
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
    line_.Show(SequenceProgressText(num_done, num_frames, *num_resumed_, elapsed.count()));
    if (num_done == num_frames) line_.End();
  }
  /// Ends the line of a run that is not complete.
  void Break() const { line_.End(); }

 private:
  TerminalLine line_;
  std::optional<std::uint32_t> num_resumed_;
  std::chrono::steady_clock::time_point begin_;
};

using Simulators = std::vector<std::unique_ptr<Simulator>>;

// Checks that the run can be made, and chooses the frames of the sensors after the first.
void CheckFrames(const CommandedRun& run,
                 const Simulators& simulators,
                 bool has_commands,
                 Runs& runs) {
  const SequenceSpec& first = runs.sensors.front().spec;
  const ScanPattern& first_pattern = simulators.front()->pattern();
  for (std::size_t i = 0; i < simulators.size(); ++i) {
    const ScanPattern& pattern = simulators[i]->pattern();
    const std::uint32_t last_of_first = LastFrameOf(first, first_pattern);
    if (i > 0) SetFrames(first, first_pattern, pattern, runs.sensors[i]);
    const std::uint32_t start_frame = runs.sensors[i].spec.start_frame;
    const std::uint32_t last = i == 0 ? last_of_first : LastFrameOf(runs.sensors[i].spec, pattern);
    CheckStaysOnTracks(run, pattern, start_frame, last);
    // A log of commands reproduces what happened, be it a collision. What the vehicle meets does
    // not depend on the sensor.
    if (has_commands || i > 0) continue;
    CheckVehicleIsClear(runs.scenario(), simulators[i]->world(), pattern, start_frame, last);
  }
}

// The rung that each sensor's sequence uses if the program is to choose it.
void ChooseFidelities(const Simulators& simulators, Runs& runs) {
  if (runs.whole.fidelity != Fidelity::kAuto) return;
  for (std::size_t i = 0; i < simulators.size(); ++i) {
    SensorRun& sensor = runs.sensors[i];
    const FidelityChoice choice = ChooseFidelity(*simulators[i], sensor);
    if (runs.is_in_folders) std::cout << ShownLines(sensor.name) << ":\n";
    std::cout << ChoiceText(choice, sensor.scenario.tolerance) << std::flush;
  }
}

// Completes a directory whose sequences are complete.
int Finish(const SequenceOptions& options, const Runs& runs, const Simulators& simulators) {
  if (options.is_merged) {
    const ProgressLine progress;
    bool is_merged = false;
    simulators.front()->Execute([&] {
      is_merged = WriteMergedClouds(
          options.made.directory, MergedSensorsOf(simulators, runs.sensors),
          [&](double done) { progress.Show("merged clouds", done); }, StopRequested);
    });
    progress.End();
    if (!is_merged) {
      std::cerr << "interrupted; the same command merges the clouds\n";
      return kExitInterrupted;
    }
  }
  if (runs.is_in_folders) {
    std::optional<std::filesystem::path> merged;
    if (options.is_merged) merged = options.made.directory / kMergedFolder;
    WriteFileWhole(options.made.directory / kSensorsFile, SensorsJson(runs.sensors, merged));
  }
  return kExitSuccess;
}

int Report(const SequenceOptions& options,
           const Runs& runs,
           const Simulators& simulators,
           const std::vector<SequenceResult>& results) {
  bool is_complete = true;
  std::vector<SummarizedRun> summarized;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const SensorRun& sensor = runs.sensors[i];
    std::cout << ShownLines(Summary(sensor.spec, results[i]));
    is_complete = is_complete && results[i].is_complete;
    summarized.push_back({sensor.name, sensor.spec, results[i]});
  }
  if (options.summary) WriteFileWhole(*options.summary, SummaryJson(summarized));
  if (is_complete) return Finish(options, runs, simulators);
  std::cerr << "interrupted; the same command continues with frame ";
  const char* separator = "";
  for (std::size_t i = 0; i < results.size(); ++i) {
    const SensorRun& sensor = runs.sensors[i];
    if (results[i].is_complete) continue;
    std::cerr << separator << sensor.spec.FrameAt(results[i].num_done);
    if (runs.is_in_folders) std::cerr << " of " << ShownLines(sensor.name);
    separator = ", ";
  }
  std::cerr << "\n";
  return kExitInterrupted;
}

std::vector<SequenceResult> MakeFrames(CommandedRun& run,
                                       const Simulators& simulators,
                                       const Runs& runs,
                                       bool has_commands) {
  ProgressDisplay display;
  const SequenceHooks hooks = {
      [&](std::uint32_t num_done, std::uint32_t num_frames) { display.Show(num_done, num_frames); },
      StopRequested};
  std::vector<SequenceResult> results =
      MakeSequences(run, simulators, runs.sensors, has_commands, hooks);
  if (!std::all_of(results.begin(), results.end(),
                   [](const SequenceResult& each) { return each.is_complete; })) {
    display.Break();
  }
  return results;
}

// A file in the directory of the frames would be a stranger there.
void CheckSummary(const SequenceOptions& options) {
  if (!options.summary) return;
  const auto directory = std::filesystem::weakly_canonical(options.made.directory);
  const auto file = std::filesystem::weakly_canonical(*options.summary);
  if (std::mismatch(directory.begin(), directory.end(), file.begin(), file.end()).first ==
      directory.end()) {
    throw InputError("--summary: must not be in the directory of --out (got " +
                     ShownPath(*options.summary) + ")");
  }
  CheckCanWrite(*options.summary);
}

int RunSequenceCommand(const SequenceOptions& options) {
  CheckSummary(options);
  Runs runs = ReadForSequence(options);
  const CommandLog log = ReadLog(options, runs);
  if (options.is_verbose) std::cerr << "read " << ShownPath(options.scenario) << "\n";
  const Simulators simulators =
      MakeSimulators(runs.scenario(), options.num_threads, runs.sensors.front().spec.isa);
  std::vector<Simulator*> pointers;
  for (std::size_t i = 0; i < simulators.size(); ++i) {
    SensorRun& sensor = runs.sensors[i];
    // An empty log makes the same run as no log.
    if (!log.commands.empty()) sensor.spec.commands_jsonl = CommandLogText(log);
    CheckSameFiles(sensor.scenario, sensor.spec.identity);
    pointers.push_back(simulators[i].get());
    if (options.is_verbose) {
      std::cerr << "made the simulator: " << pointers.back()->pattern().num_firings()
                << " firings a frame, " << pointers.back()->world().objects().size() << " objects, "
                << log.commands.size() << " commands\n";
    }
  }
  CommandedRun run(runs.scenario(), pointers);
  AtPlace(ShownPath(options.commands.value_or("")) + ": ", [&] { run.Apply(log.commands); });
  CheckFrames(run, simulators, !log.commands.empty(), runs);
  if (options.is_merged) CheckCanMerge(MergedSensorsOf(simulators, runs.sensors));
  // The directory can be resumed however the program ends.
  CatchStopSignals();
  for (Simulator* simulator : pointers) WatchBuilding(*simulator, StopRequested, true);
  try {
    ChooseFidelities(simulators, runs);
  } catch (const RunStopped&) {
    std::cerr << "interrupted before the first frame\n";
    return kExitInterrupted;
  }
  return Report(options, runs, simulators,
                MakeFrames(run, simulators, runs, !log.commands.empty()));
}

}  // namespace

void AddSequence(CLI::App& app, ProgramCommand& command) {
  const auto options = std::make_shared<SequenceOptions>();
  CLI::App* sequence = app.add_subcommand(
      "sequence",
      "Write labelled frames to files; run the same command again to continue an interrupted run");
  sequence->add_option("SCENARIO", options->scenario, "Scenario file")
      ->required()
      ->check(NonEmpty());
  sequence->add_option("--out", options->made.directory, "Directory to write the frames to")
      ->required()
      ->check(NonEmpty());
  sequence
      ->add_option(
          "--frames", options->made.num_frames,
          "Number of frames to make; other sensors than the first make those of the same time")
      ->transform(Whole({1, kMaxFrame}))
      ->capture_default_str();
  sequence->add_option("--start-frame", options->made.start_frame, "Number of the first frame")
      ->transform(Whole({0, kMaxFrame}))
      ->capture_default_str();
  sequence
      ->add_option("--stride", options->made.stride,
                   "Every how many-th of the scenario's frames to make; 1 = all")
      ->transform(Whole({1, kMaxFrame}))
      ->capture_default_str();
  sequence->add_option("--format", options->made.format, "File format of the frames")
      ->check(CLI::IsMember(FrameFormatNames()))
      ->capture_default_str();
  sequence
      ->add_option("--fields", options->made.fields, "Fields to write, separated by commas, or all")
      ->capture_default_str();
  sequence->add_option("--seed", options->seed, "Seed to use instead of the scenario's")
      ->transform(Whole({}));
  sequence->add_option("--threads", options->num_threads, "Number of threads; 0 = all cores")
      ->transform(Whole({0, 1024}))
      ->capture_default_str();
  sequence->add_option("--fidelity", options->fidelity, "Fidelity to use instead of the scenario's")
      ->check(CLI::IsMember(NamesOf<Fidelity>()));
  AddIsa(*sequence, options->made.isa);
  sequence->add_option(
      "--sensor", options->sensor,
      "Name of the only sensor to simulate; without it, each of several sensors gets a "
      "folder of its name in --out");
  sequence->add_flag("--merged", options->is_merged,
                     "Also write the clouds of all sensors together, in the vehicle's axes, with "
                     "the field sensor_index");
  sequence
      ->add_option(
          "--commands", options->commands,
          "Command log of a live run to replay; with that run's scenario it reproduces its frames")
      ->check(NonEmpty());
  AddSummaryFile(*sequence, options->summary);
  sequence->footer(
      "Exit status: 0 success, 1 bad input or failed run, 2 usage, 130 interrupted (the same\n"
      "command continues).");
  sequence->callback([&app, &command, options] {
    options->is_verbose = app.count("--verbose") > 0;
    CheckFields(options->made.fields);
    command = [options](const std::string&) { return RunSequenceCommand(*options); };
  });
}

}  // namespace railcast
