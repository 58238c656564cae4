#include "generator/sequence/run_sequence.h"

#include <array>
#include <chrono>
#include <future>

#include "core/base/out_of_memory.h"
#include "generator/run/stoppable_work.h"
#include "generator/sequence/sequence_directory.h"

namespace railcast {
namespace {

struct MadeFrame {
  Frame frame;
  std::vector<ObjectInFrame> objects;
  CameraImage image;
  bool has_image = false;
};

/// What a run makes.
struct Sources {
  const FrameSource& frame;
  const ImageSource& image;
};

void MakeMissingFrames(const SequenceSpec& spec,
                       const Sources& sources,
                       const SequenceHooks& hooks,
                       SequenceDirectory& directory) {
  const std::uint32_t num_resumed = directory.num_done();
  // One is computed while the other is written.
  std::array<MadeFrame, 2> made;
  std::future<void> writing;
  const auto await_writing = [&] {
    if (!writing.valid()) return;
    writing.get();
    hooks.on_progress(directory.num_done(), spec.num_frames);
  };
  for (std::uint32_t i = num_resumed; i < spec.num_frames && !hooks.is_stopped(); ++i) {
    MadeFrame& next = made[i % 2];
    next.objects.clear();
    try {
      sources.frame(spec.start_frame + i, next.frame, next.objects);
      next.has_image = sources.image && sources.image(spec.start_frame + i, next.image);
    } catch (const RunStopped&) {
      break;
    }
    await_writing();
    const auto doing = [&next] {
      return "writing frame " + std::to_string(next.frame.index) + " (" +
             std::to_string(next.frame.num_slots()) + " slots)";
    };
    writing = WithinMemory(doing, [&] {
      return std::async(std::launch::async, [&directory, &next, doing] {
        WithinMemory(doing, [&] {
          directory.Write(next.frame, next.objects, next.has_image ? &next.image : nullptr);
        });
      });
    });
  }
  await_writing();
}

}  // namespace

SequenceResult RunSequence(const SequenceSpec& spec,
                           const FrameSource& make_frame,
                           const SequenceHooks& hooks,
                           const ImageSource& make_image) {
  SequenceDirectory directory(spec);
  SequenceResult result;
  result.num_resumed = directory.num_done();
  result.was_complete = directory.is_complete();
  if (!result.was_complete) {
    const auto begin = std::chrono::steady_clock::now();
    hooks.on_progress(directory.num_done(), spec.num_frames);
    MakeMissingFrames(spec, {make_frame, make_image}, hooks, directory);
    if (directory.num_done() == spec.num_frames) directory.Finish();
    result.elapsed_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
  result.num_done = directory.num_done();
  result.is_complete = directory.is_complete();
  result.counts = directory.counts();
  return result;
}

}  // namespace railcast
