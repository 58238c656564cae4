#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "generator/record/frame_record.h"
#include "generator/record/object_record.h"
#include "generator/run/run_identity.h"
#include "railcast/camera.h"
#include "railcast/frame.h"

namespace railcast {

/// What is written of one frame. Its memory is reused.
struct MadeFrame {
  Frame frame;
  std::vector<ObjectInFrame> objects;  ///< The records of the world's objects.
  CameraImage image;
  bool has_image = false;  ///< Whether the camera has an image of this frame.
};

/// Makes one frame. Called once, by any thread, while other frames may be made.
using FrameJob = std::function<void(MadeFrame& made)>;

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
};

struct SequenceResult {
  std::uint32_t num_resumed{};  ///< Frames made by an earlier run.
  std::uint32_t num_done{};     ///< All frames in the directory.
  bool was_complete{};          ///< All frames were there before.
  bool is_complete{};           ///< All frames and the manifest are there.
  FrameCounts counts;           ///< Over all frames in the directory.
  double elapsed_s{};           ///< Wall-clock time for the frames made in this run.
};

/// One of several sequences that are made together, one for each sensor.
struct SensorSequence {
  SequenceSpec spec;
  BeginFrame begin_frame;
  /// The time at which a frame of the sensor begins.
  std::function<std::int64_t(std::uint32_t index)> stamp_ns;
};

/// Makes the missing frames of several sequences in one pass through simulation time: the frame
/// that begins first is made first. Otherwise as RunSequence(), with progress over all of them.
/// @return The results in the order of the sequences; each has the same `elapsed_s`.
[[nodiscard]] std::vector<SequenceResult> RunSequences(const std::vector<SensorSequence>& sensors,
                                                       const SequenceHooks& hooks,
                                                       const FramesAtOnce& at_once = {});

/// Makes the frames of a sequence that its directory does not hold yet. Frames are made and encoded
/// several at once, and written in their order; as many more wait to be written meanwhile. If one
/// cannot be made, those before it are written before the exception is passed on.
/// @throws InputError as SequenceDirectory does.
[[nodiscard]] SequenceResult RunSequence(const SequenceSpec& spec,
                                         const BeginFrame& begin_frame,
                                         const SequenceHooks& hooks,
                                         const FramesAtOnce& at_once = {});

}  // namespace railcast
