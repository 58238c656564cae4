#include <chrono>
#include <iostream>
#include <optional>
#include <utility>

#include "core/base/attempt.h"
#include "core/base/error.h"
#include "core/base/shown_text.h"
#include "core/fidelity/choice_report.h"
#include "core/io/scenario_identity.h"
#include "core/io/version.h"
#include "core/scenario/command_log.h"
#include "core/scenario/effects.h"
#include "core/scenario/scenario.h"
#include "core/trace/trace_program.h"
#include "generator/chosen_fidelity.h"
#include "generator/commanded_run.h"
#include "generator/commands.h"
#include "generator/frame_limits.h"
#include "generator/object_survey.h"
#include "generator/run_sequence.h"
#include "generator/run_stopped.h"
#include "generator/stop_signal.h"
#include "generator/summary.h"
#include "generator/terminal_line.h"
#include "generator/track_limits.h"
#include "generator/watch_building.h"

namespace railcast {
namespace {

// The whole scenario, of which a log is, and the one sensor that the frames are of.
struct Scenarios {
  ScenarioSpec whole;
  ScenarioSpec of_sensor;
};

Scenarios ReadWithOverrides(const SequenceOptions& options) {
  ScenarioSpec scenario = ReadScenario(options.scenario);
  if (options.seed) scenario.seed = *options.seed;
  if (options.fidelity) scenario.fidelity = *options.fidelity;
  const bool is_sensor_frame =
      scenario.output.frame == "sensor" && scenario.output.handedness == "right";
  if (options.format == "kitti" && !is_sensor_frame) {
    throw InputError(ShownPath(options.scenario) +
                     ": /output: must be right-handed sensor coordinates for --format kitti (got " +
                     scenario.output.handedness + "-handed " + scenario.output.frame + ")");
  }
  ScenarioSpec of_sensor = PickSensor(scenario, options.sensor);
  return {std::move(scenario), std::move(of_sensor)};
}

// What the log says since its last reset. It may be of all the scenario's sensors or of this one.
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
  // So that a log of all sensors and one of this one make the same run.
  log.scenario_xxh3 = whole;
  return log;
}

SequenceSpec MakeSpec(const SequenceOptions& options, const ScenarioSpec& scenario) {
  SequenceSpec spec;
  spec.directory = options.out;
  spec.version = ProgramVersion();
  spec.embree_version = EmbreeVersion();
  spec.isa = AtPlace("--", [&] { return IsaInUse(options.isa); });
  spec.identity = IdentityOf(scenario);
  spec.seed = scenario.seed;
  spec.files.format = ParseFrameFormat(options.format);
  spec.files.fields = FieldSelection(options.fields);
  if (options.format == "kitti" && options.fields != "all") {
    throw InputError(
        "--fields: KITTI's are fixed, so it must be left out with --format kitti (got " +
        options.fields + ")");
  }
  spec.files.labels = LabelTable(scenario.labels);
  spec.materials = MaterialLibrary(scenario.materials);
  spec.start_frame = options.start_frame;
  spec.num_frames = options.num_frames;
  return spec;
}

/// Makes the frames of a run and what they show.
class SurveyedRun {
 public:
  SurveyedRun(CommandedRun& run, const LabelTable& labels) : run_(run), labels_(labels) {}

  void Make(std::uint32_t index, Frame& frame, std::vector<ObjectInFrame>& objects) {
    Simulator& simulator = run_.At(0, index);
    simulator.Scan(index, frame);
    if (simulator.shared_world() != world_) {
      world_ = simulator.shared_world();
      survey_.emplace(*world_, labels_, simulator.spec().range_max_m, simulator.spec().output);
    }
    objects = survey_->Describe(frame, simulator.FiringsOnObjectAlone(index));
  }

 private:
  CommandedRun& run_;
  const LabelTable& labels_;
  std::shared_ptr<const World> world_;
  std::optional<ObjectSurvey> survey_;
};

class ProgressDisplay {
 public:
  void Show(std::uint32_t num_done, std::uint32_t num_frames) {
    if (!num_resumed_) {
      num_resumed_ = num_done;
      begin_ = std::chrono::steady_clock::now();
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
    line_.Show(ProgressLine(num_done, num_frames, *num_resumed_, elapsed.count()));
    if (num_done == num_frames) line_.End();
  }
  /// Of a run that is not complete.
  void Break() const { line_.End(); }

 private:
  TerminalLine line_;
  std::optional<std::uint32_t> num_resumed_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace

int SequenceCommand(const SequenceOptions& options) {
  const Scenarios scenarios = ReadWithOverrides(options);
  const ScenarioSpec& scenario = scenarios.of_sensor;
  const CommandLog log = ReadLog(options, scenarios);
  SequenceSpec spec = MakeSpec(options, scenario);
  // A log that says nothing makes the same run as none.
  if (!log.commands.empty()) spec.commands_jsonl = CommandLogText(log);
  if (options.is_verbose) std::cerr << "read " << ShownPath(options.scenario) << "\n";
  const auto simulator = MakeSimulator(scenario, options.num_threads, spec.isa);
  CheckSameFiles(scenario, spec.identity);
  if (options.is_verbose) {
    std::cerr << "made the simulator: " << simulator->pattern().num_firings()
              << " firings a frame, " << simulator->world().objects().size() << " objects, "
              << log.commands.size() << " commands\n";
  }
  const std::uint32_t last_frame = spec.start_frame + spec.num_frames - 1;
  CheckHasStamp("--start-frame, --frames", simulator->pattern(), last_frame);
  CommandedRun run(scenario, {simulator.get()});
  AtPlace(ShownPath(options.commands.value_or("")) + ": ", [&] { run.Apply(log.commands); });
  CheckStaysOnTracks(run, simulator->pattern(), spec.start_frame, last_frame);
  // Whatever ends the program, the directory can be resumed.
  CatchStopSignals();
  WatchBuilding(*simulator, StopRequested, true);
  if (scenario.fidelity == kAutoFidelity) {
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
  ProgressDisplay display;
  const SequenceHooks hooks = {
      [&](std::uint32_t num_done, std::uint32_t num_frames) { display.Show(num_done, num_frames); },
      StopRequested};
  const SequenceResult result = RunSequence(
      spec,
      [&](std::uint32_t index, Frame& frame, std::vector<ObjectInFrame>& objects) {
        frames.Make(index, frame, objects);
      },
      hooks);
  if (!result.is_complete) display.Break();
  std::cout << ShownLines(Summary(spec, result));
  if (result.is_complete) return kExitSuccess;
  std::cerr << "interrupted; the same command continues with frame "
            << spec.start_frame + result.num_done << "\n";
  return kExitInterrupted;
}

}  // namespace railcast
