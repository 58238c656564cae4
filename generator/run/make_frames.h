#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/io/run/frame_record.h"
#include "generator/run/frame_maker.h"
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

/// Callbacks of a sequence run. Each is called by one thread at a time.
struct SequenceHooks {
  /// Called after every frame and once before the first.
  std::function<void(std::uint32_t num_done, std::uint32_t num_frames)> on_progress;
  /// Called before every frame; if it returns true, the run ends after the frames under way.
  std::function<bool()> is_stopped;
  /// Whether nothing else is made beside it: then the terminal shows what it waits for, and
  /// stopping it has a deadline meanwhile (WatchBuilding()).
  bool is_alone = true;
};

struct SequenceResult {
  std::uint32_t num_resumed{};  ///< Frames made by an earlier run.
  std::uint32_t num_done{};     ///< All frames in the directory.
  bool was_complete{};          ///< All frames were there before.
  /// What was not as it was written in a complete directory and was made anew, a line each.
  std::vector<std::string> changed{};
  bool is_complete{};  ///< All frames and the manifest are there.
  FrameCounts counts;  ///< Over all frames in the directory.
  double elapsed_s{};  ///< Wall-clock time for the frames made in this run.
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

/// Makes the missing frames of a plan in one pass through simulation time: of all sensors, the
/// frame that begins first is made first. Otherwise as RunSequence(), with progress over all of
/// them.
/// @return The results in the order of the sensors; each has the same `elapsed_s`.
[[nodiscard]] std::vector<SequenceResult> MakeFrames(FrameMaker& maker,
                                                     const RunPlan& plan,
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
