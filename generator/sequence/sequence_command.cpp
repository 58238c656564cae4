#include <chrono>
#include <functional>
#include <iostream>
#include <optional>
#include <utility>

#include "core/base/attempt.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/fidelity/choice_report.h"
#include "core/io/scenario_identity.h"
#include "core/program/progress_line.h"
#include "core/scenario/command_log.h"
#include "core/scenario/vehicle_clearance.h"
#include "generator/commands.h"
#include "generator/run/commanded_run.h"
#include "generator/run/run_options.h"
#include "generator/run/stop_signal.h"
#include "generator/run/stoppable_work.h"
#include "generator/run/track_limits.h"
#include "generator/sequence/run_sequence.h"
#include "generator/sequence/scenario_sequence.h"
#include "generator/sequence/summary.h"
#include "generator/sequence/surveyed_run.h"
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
  int num_threads = 0;                            ///< 0 = all cores.
  bool is_verbose = false;
};

// The whole scenario, to which a log may belong, and its reduction to the sensor of the frames.
struct Scenarios {
  ScenarioSpec whole;
  ScenarioSpec of_sensor;
};

Scenarios ReadForSequence(const SequenceOptions& options) {
  ScenarioSpec scenario = ReadScenario(options.scenario);
  if (options.seed) scenario.seed = *options.seed;
  if (options.fidelity) scenario.fidelity = ValueNamed<Fidelity>(*options.fidelity).value();
  CheckOutputSuits(options.made.format, scenario, ShownPath(options.scenario));
  ScenarioSpec of_sensor = PickSensor(scenario, options.sensor);
  return {std::move(scenario), std::move(of_sensor)};
}

// Returns the commands of the log since its last reset. The log may belong to all the scenario's
// sensors or to this one alone.
CommandLog ReadLog(const SequenceOptions& options, const Scenarios& scenarios) {
  CommandLog log;
  if (!options.commands) return log;
  log = ReadCommandLog(*options.commands);
  const std::string whole = IdentityOf(scenarios.whole).scenario_hash;
  if (log.scenario_xxh3 != whole &&
      log.scenario_xxh3 != IdentityOf(scenarios.of_sensor).scenario_hash) {
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

int RunSequenceCommand(const SequenceOptions& options) {
  const Scenarios scenarios = ReadForSequence(options);
  const ScenarioSpec& scenario = scenarios.of_sensor;
  const CommandLog log = ReadLog(options, scenarios);
  SequenceSpec spec = SequenceSpecOf(scenario, options.made);
  // An empty log makes the same run as no log.
  if (!log.commands.empty()) spec.commands_jsonl = CommandLogText(log);
  if (options.is_verbose) std::cerr << "read " << ShownPath(options.scenario) << "\n";
  const auto simulator = MakeSimulator(scenario, options.num_threads, spec.isa);
  CheckSameFiles(scenario, spec.identity);
  if (options.is_verbose) {
    std::cerr << "made the simulator: " << simulator->pattern().num_firings()
              << " firings a frame, " << simulator->world().objects().size() << " objects, "
              << log.commands.size() << " commands\n";
  }
  const std::uint32_t last_frame = LastFrameOf(spec, simulator->pattern());
  CommandedRun run(scenario, {simulator.get()});
  AtPlace(ShownPath(options.commands.value_or("")) + ": ", [&] { run.Apply(log.commands); });
  CheckStaysOnTracks(run, simulator->pattern(), spec.start_frame, last_frame);
  // A log of commands reproduces what happened, be it a collision.
  if (log.commands.empty()) {
    CheckVehicleIsClear(scenario, simulator->world(), simulator->pattern(), spec.start_frame,
                        last_frame);
  }
  // The directory can be resumed however the program ends.
  CatchStopSignals();
  WatchBuilding(*simulator, StopRequested, true);
  if (scenario.fidelity == Fidelity::kAuto) {
    try {
      const FidelityChoice choice = UseChosenFidelity(*simulator, scenario);
      spec.fidelity_choice_json = ChoiceJson(choice, scenario.tolerance);
      std::cout << ChoiceText(choice, scenario.tolerance) << std::flush;
    } catch (const RunStopped&) {
      std::cerr << "interrupted before the first frame\n";
      return kExitInterrupted;
    }
  }
  SurveyedRun frames(run, spec.files.labels);
  // Commands change the simulator from one frame to the next.
  const FramesAtOnce at_once = {
      log.commands.empty() ? NumFramesAtOnce(*simulator, scenario) : 1,
      [&](const std::function<void()>& work) { simulator->Execute(work); }};
  ProgressDisplay display;
  const SequenceHooks hooks = {
      [&](std::uint32_t num_done, std::uint32_t num_frames) { display.Show(num_done, num_frames); },
      StopRequested};
  const SequenceResult result = RunSequence(
      spec, [&](std::uint32_t index) { return frames.Begin(index); }, hooks, at_once);
  if (!result.is_complete) display.Break();
  std::cout << ShownLines(Summary(spec, result));
  if (result.is_complete) return kExitSuccess;
  std::cerr << "interrupted; the same command continues with frame "
            << spec.FrameAt(result.num_done) << "\n";
  return kExitInterrupted;
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
  sequence->add_option("--frames", options->made.num_frames, "Number of frames to make")
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
  sequence->add_option("--sensor", options->sensor,
                       "Name of the sensor to simulate, where the scenario has several");
  sequence
      ->add_option(
          "--commands", options->commands,
          "Command log of a live run to replay; with that run's scenario it reproduces its frames")
      ->check(NonEmpty());
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
