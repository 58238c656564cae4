#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "generator/sequence/frame_record.h"
#include "generator/sequence/object_record.h"
#include "generator/sequence/sequence_spec.h"
#include "railcast/camera.h"
#include "railcast/frame.h"

namespace railcast {

/// Makes frame `index` and the records of the world's objects in it. Called by one thread, in
/// order. If it throws RunStopped, the run ends after the previous frame.
using FrameSource =
    std::function<void(std::uint32_t index, Frame& frame, std::vector<ObjectInFrame>& objects)>;

/// Makes the camera's image of frame `index`, right after the frame. Returns false if that frame
/// has none.
using ImageSource = std::function<bool(std::uint32_t index, CameraImage& image)>;

/// Callbacks of a sequence run.
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

/// Makes the frames of a sequence that its directory does not hold yet. The next frame is computed
/// while one is written.
/// @param make_image Empty if there is no camera.
/// @throws InputError as SequenceDirectory does.
[[nodiscard]] SequenceResult RunSequence(const SequenceSpec& spec,
                                         const FrameSource& make_frame,
                                         const SequenceHooks& hooks,
                                         const ImageSource& make_image = {});

}  // namespace railcast
