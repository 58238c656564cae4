#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <iostream>

#include "core/base/error.h"
#include "core/scenario/scenario.h"
#include "generator/commands.h"
#include "generator/object_record.h"
#include "generator/run_sequence.h"
#include "generator/summary.h"

namespace railcast {
namespace {

// A signal handler can reach nothing else.
std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void StopAfterThisFrameOnSignals() {
  struct sigaction action {};
  action.sa_handler = [](int) { stop_requested = true; };
  // A second Ctrl-C ends the program at once; the directory can be resumed all the same.
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

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
  spec.seed = scenario.seed;
  spec.files.format = ParseFrameFormat(options.format);
  spec.files.fields = FieldSelection(options.fields);
  spec.files.labels = LabelTable(scenario.labels);
  spec.start_frame = options.start_frame;
  spec.num_frames = options.num_frames;
  return spec;
}

FrameSource MakeSource(Simulator& simulator, const LabelTable& labels) {
  return [&simulator, &labels](std::uint32_t index, Frame& frame,
                               std::vector<ObjectInFrame>& objects) {
    simulator.Scan(index, frame);
    objects =
        DescribeObjects(simulator.world(), labels, frame, simulator.FiringsOnObjectAlone(index));
  };
}

// Rewrites one line of a terminal; silent elsewhere.
class ProgressDisplay {
 public:
  void Show(std::uint32_t num_done, std::uint32_t num_frames) {
    if (!is_terminal_) return;
    if (!num_resumed_) {
      num_resumed_ = num_done;
      begin_ = std::chrono::steady_clock::now();
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
    // CR: to the line's begin. ESC [K: clear to its end.
    std::cerr << "\r\033[K" << ProgressLine(num_done, num_frames, *num_resumed_, elapsed.count())
              << (num_done == num_frames ? "\n" : "") << std::flush;
  }

 private:
  bool is_terminal_ = ::isatty(STDERR_FILENO) == 1;
  std::optional<std::uint32_t> num_resumed_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace

int SequenceCommand(const SequenceOptions& options) {
  const ScenarioSpec scenario = ReadWithOverrides(options);
  const SequenceSpec spec = MakeSpec(options, scenario);
  if (options.is_verbose) std::cerr << "read " << options.scenario.string() << "\n";
  const auto simulator = MakeSimulator(scenario, options.num_threads);
  if (options.is_verbose) {
    std::cerr << "made the simulator: " << simulator->pattern().num_firings()
              << " firings a frame, " << simulator->world().objects().size() << " objects\n";
  }
  StopAfterThisFrameOnSignals();
  ProgressDisplay display;
  const SequenceHooks hooks = {
      [&](std::uint32_t num_done, std::uint32_t num_frames) { display.Show(num_done, num_frames); },
      [] { return stop_requested.load(); }};
  const SequenceResult result = RunSequence(spec, MakeSource(*simulator, spec.files.labels), hooks);
  std::cout << Summary(spec, result);
  if (result.is_complete) return kExitSuccess;
  std::cerr << "interrupted; the same command continues with frame "
            << spec.start_frame + result.num_done << "\n";
  return kExitInterrupted;
}

}  // namespace railcast
