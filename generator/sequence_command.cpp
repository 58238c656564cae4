#include <chrono>
#include <iostream>

#include "core/base/error.h"
#include "core/fidelity/choice_report.h"
#include "core/rail/rail_world.h"
#include "core/scenario/effects.h"
#include "core/scenario/scenario.h"
#include "generator/chosen_fidelity.h"
#include "generator/commands.h"
#include "generator/object_survey.h"
#include "generator/run_sequence.h"
#include "generator/scenario_identity.h"
#include "generator/stop_signal.h"
#include "generator/summary.h"
#include "generator/terminal_line.h"
#include "generator/track_limits.h"

namespace railcast {
namespace {

ScenarioSpec ReadWithOverrides(const SequenceOptions& options) {
  ScenarioSpec scenario = ReadScenario(options.scenario);
  if (options.seed) scenario.seed = *options.seed;
  if (options.fidelity) scenario.fidelity = *options.fidelity;
  const bool is_sensor_frame =
      scenario.output.frame == "sensor" && scenario.output.handedness == "right";
  if (options.format == "kitti" && !is_sensor_frame) {
    throw InputError(options.scenario.string() +
                     ": /output: must be right-handed sensor coordinates for --format kitti (got " +
                     scenario.output.handedness + "-handed " + scenario.output.frame + ")");
  }
  return scenario;
}

SequenceSpec MakeSpec(const SequenceOptions& options, const ScenarioSpec& scenario) {
  SequenceSpec spec;
  spec.directory = options.out;
  spec.version = RAILCAST_VERSION;
  spec.scenario_json = ResolvedScenarioJson(scenario);
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

FrameSource MakeSource(Simulator& simulator, const ObjectSurvey& survey) {
  return [&simulator, &survey](std::uint32_t index, Frame& frame,
                               std::vector<ObjectInFrame>& objects) {
    simulator.Scan(index, frame);
    objects = survey.Describe(frame, simulator.FiringsOnObjectAlone(index));
  };
}

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

 private:
  TerminalLine line_;
  std::optional<std::uint32_t> num_resumed_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace

int SequenceCommand(const SequenceOptions& options) {
  const ScenarioSpec scenario = ReadWithOverrides(options);
  SequenceSpec spec = MakeSpec(options, scenario);
  if (options.is_verbose) std::cerr << "read " << options.scenario.string() << "\n";
  const auto simulator = MakeSimulator(scenario, options.num_threads);
  if (options.is_verbose) {
    std::cerr << "made the simulator: " << simulator->pattern().num_firings()
              << " firings a frame, " << simulator->world().objects().size() << " objects\n";
  }
  // The simulator's world is the one that the scenario describes.
  CheckStaysOnTracks(scenario, dynamic_cast<const RailWorld&>(simulator->world()),
                     simulator->pattern(), spec.start_frame,
                     spec.start_frame + spec.num_frames - 1);
  if (scenario.fidelity == kAutoFidelity) {
    const FidelityChoice choice = UseChosenFidelity(*simulator, scenario);
    spec.fidelity_choice_json = ChoiceJson(choice, scenario.tolerance);
    std::cout << ChoiceText(choice, scenario.tolerance) << std::flush;
  }
  const ObjectSurvey survey(simulator->world(), spec.files.labels, scenario.lidar.range_max_m,
                            scenario.output);
  // Whatever ends the program, the directory can be resumed.
  CatchStopSignals();
  ProgressDisplay display;
  const SequenceHooks hooks = {
      [&](std::uint32_t num_done, std::uint32_t num_frames) { display.Show(num_done, num_frames); },
      StopRequested};
  const SequenceResult result = RunSequence(spec, MakeSource(*simulator, survey), hooks);
  std::cout << Summary(spec, result);
  if (result.is_complete) return kExitSuccess;
  std::cerr << "interrupted; the same command continues with frame "
            << spec.start_frame + result.num_done << "\n";
  return kExitInterrupted;
}

}  // namespace railcast
