#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/io/run/frame_record.h"
#include "core/io/run/run_folder.h"
#include "generator/run/frame_maker.h"
#include "generator/run/frame_pipe.h"
#include "generator/run/run_plan.h"
#include "railcast/fidelity.h"

namespace railcast {

/// Begins frame `index` and returns what makes it. Called in order, by one thread at a time. If it
/// or the job throws RunStopped, the run ends after the previous frame.
using BeginFrame = std::function<FrameJob(std::uint32_t index)>;

/// How many frames are made at once, and where.
struct FramesAtOnce {
  std::size_t num = 1;
  /// Calls a function on the run's threads, which TBB's algorithms within it use.
  std::function<void(const std::function<void()>& work)> execute =
      [](const std::function<void()>& work) { work(); };
};

struct SequenceResult : RunResult {
  FrameCounts counts;                         ///< Over all frames in the directory.
  std::optional<RunCertificate> certificate;  ///< Over the same, if the run is certified.
  double elapsed_s{};                         ///< Wall-clock time for the frames made in this run.
};

struct SequenceHooks : RunHooks {
  /// Called by MakeFrames() before the bag's end and the merged clouds, with a result for each
  /// sensor.
  std::function<void(const std::vector<SequenceResult>& results)> on_frames = [](const auto&) {};
  /// Called with the completed share of the merged clouds.
  std::function<void(double done)> on_merged = [](double) {};
  /// Whether nothing else is made beside it: then the terminal shows what it waits for, and
  /// stopping it has a deadline meanwhile (WatchBuilding()).
  bool is_alone = true;
};

/// Has the rung `auto` choose for each sensor, and notes the choices in the plan. From now on the
/// building of scenes is watched as by WatchBuilding().
/// @param on_choice Called after each choice.
/// @return False if the run was stopped meanwhile.
[[nodiscard]] bool ChooseFidelities(
    const FrameMaker& maker,
    const std::function<void(const SensorPlan& sensor, const FidelityChoice& choice)>& on_choice,
    const SequenceHooks& hooks,
    RunPlan& plan);

/// What the certificates of a sensor's frames are about.
/// @param scenario With this sensor alone.
/// @param world That of its first frame.
[[nodiscard]] CertifySpec CertifySpecOf(const ScenarioSpec& scenario,
                                        const World& world,
                                        const Certifier& certifier,
                                        double cost_share);

/// Has the frames of those sensors certified whose plans say so, and notes in the plans what their
/// certificates are about.
/// @pre Their effects are chosen (ChooseFidelities()).
/// @throws InputError as FrameMaker::Certify().
void UseCertificates(FrameMaker& maker, RunPlan& plan);

/// How far the run of a plan has got.
struct PlanResult {
  std::vector<SequenceResult> sequences;  ///< By sensor; each has the same `elapsed_s`.
  bool is_complete{};                     ///< So are all of these, and FinishRun() is done.
};

/// The folders that the run of a plan writes to: they hold nothing but what is the run's, and no
/// other run writes there while this exists.
class RunFolders {
 public:
  /// @throws InputError as FolderLock does, or if a folder holds anything else.
  explicit RunFolders(const RunPlan& plan);

 private:
  std::deque<FolderLock> locks_;
};

/// Makes the missing frames of a plan in one pass through simulation time: of all sensors, the
/// frame that begins first is made first; then the bag's end and what is about all sensors.
/// Otherwise as RunSequence(), with progress over all frames.
/// @param folders The plan's.
[[nodiscard]] PlanResult MakeFrames(FrameMaker& maker,
                                    const RunPlan& plan,
                                    const RunFolders& folders,
                                    const SequenceHooks& hooks);

/// Makes the frames of a sequence that its directory does not hold yet. Frames are made and encoded
/// several at once, and written in their order; as many more wait to be written meanwhile. If one
/// cannot be made, those before it are written before the exception is passed on.
/// @throws InputError as RunDirectory does.
[[nodiscard]] SequenceResult RunSequence(const SequenceSpec& spec,
                                         const BeginFrame& begin_frame,
                                         const SequenceHooks& hooks,
                                         const FramesAtOnce& at_once = {});

}  // namespace railcast
