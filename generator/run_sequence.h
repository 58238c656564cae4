#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/frame/frame.h"
#include "generator/frame_record.h"
#include "generator/object_record.h"
#include "generator/sequence_spec.h"

namespace railcast {

/// Makes frame `index` and what it shows of the world's objects. Called by one thread, in order. If
/// it throws RunStopped, the run ends after the frames before.
using FrameSource =
    std::function<void(std::uint32_t index, Frame& frame, std::vector<ObjectInFrame>& objects)>;

/// What a sequence run tells and asks while it works.
struct SequenceHooks {
  /// After every frame and once before the first.
  std::function<void(std::uint32_t num_done, std::uint32_t num_frames)> on_progress;
  /// Asked before every frame; true ends the run after the frames under way.
  std::function<bool()> is_stopped;
};

struct SequenceResult {
  std::uint32_t num_resumed{};  ///< Frames that an earlier run had made.
  std::uint32_t num_done{};     ///< All frames in the directory.
  bool was_complete{};          ///< There was nothing to do.
  bool is_complete{};           ///< All frames are there, and the manifest.
  FrameCounts counts;           ///< Of all frames in the directory.
  double elapsed_s{};           ///< Of wall clock, for the frames made now.
};

/// Makes the frames of a sequence that its directory does not hold yet. While one frame is written
/// the next is computed.
/// @throws InputError as SequenceDirectory does.
[[nodiscard]] SequenceResult RunSequence(const SequenceSpec& spec,
                                         const FrameSource& make_frame,
                                         const SequenceHooks& hooks);

}  // namespace railcast
