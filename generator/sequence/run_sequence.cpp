#include "generator/sequence/run_sequence.h"

#include <tbb/parallel_pipeline.h>

#include <chrono>
#include <exception>
#include <future>
#include <utility>

#include "core/base/out_of_memory.h"
#include "generator/run/stoppable_work.h"
#include "generator/sequence/sequence_directory.h"

namespace railcast {
namespace {

/// The memory of a frame from its beginning until it is written.
struct FrameSlot {
  FrameJob job;
  std::exception_ptr fault;  ///< Why there is no frame.
  MadeFrame made;
  EncodedFrame encoded;
};

class MissingFrames {
 public:
  MissingFrames(const SequenceSpec& spec,
                const BeginFrame& begin_frame,
                const SequenceHooks& hooks,
                const FramesAtOnce& at_once,
                SequenceDirectory& directory)
      : spec_(spec),
        begin_frame_(begin_frame),
        hooks_(hooks),
        directory_(directory),
        next_(directory.num_done()),
        // The pipeline holds at_once.num frames, and the one before them is being written.
        slots_(at_once.num + 1) {}

  /// Makes frames until there is none left, or the run is stopped.
  void Make() {
    tbb::parallel_pipeline(
        slots_.size() - 1,
        tbb::make_filter<void, FrameSlot*>(tbb::filter_mode::serial_in_order,
                                           [this](tbb::flow_control& flow) {
                                             FrameSlot* const slot = Begin();
                                             if (slot == nullptr) flow.stop();
                                             return slot;
                                           }) &
            tbb::make_filter<FrameSlot*, FrameSlot*>(tbb::filter_mode::parallel,
                                                     [this](FrameSlot* slot) {
                                                       Finish(*slot);
                                                       return slot;
                                                     }) &
            tbb::make_filter<FrameSlot*, void>(tbb::filter_mode::serial_in_order,
                                               [this](FrameSlot* slot) { Write(*slot); }));
  }

  /// Waits for the frame that is being written.
  void AwaitWriting() {
    if (!writing_.valid()) return;
    writing_.get();
    hooks_.on_progress(directory_.num_done(), spec_.num_frames);
  }

 private:
  // Returns null if no frame is left.
  FrameSlot* Begin() {
    if (is_over_ || next_ >= spec_.num_frames || hooks_.is_stopped()) return nullptr;
    FrameSlot& slot = slots_[next_ % slots_.size()];
    slot.fault = nullptr;
    try {
      slot.job = begin_frame_(spec_.start_frame + next_);
    } catch (...) {
      // Passed on in its turn, after the frames before it.
      slot.fault = std::current_exception();
      is_over_ = true;
    }
    ++next_;
    return &slot;
  }

  void Finish(FrameSlot& slot) const {
    if (slot.fault) return;
    try {
      MadeFrame& made = slot.made;
      std::exchange(slot.job, {})(made);
      const auto doing = [&made] { return Encoding(made.frame); };
      WithinMemory(doing, [&] {
        directory_.Encode(made.frame, made.objects, made.has_image ? &made.image : nullptr,
                          slot.encoded);
      });
    } catch (...) {
      slot.fault = std::current_exception();
    }
  }

  void Write(FrameSlot& slot) {
    AwaitWriting();
    if (slot.fault) std::rethrow_exception(slot.fault);
    const auto doing = [&slot] { return Encoding(slot.made.frame); };
    writing_ = WithinMemory(doing, [&] {
      return std::async(std::launch::async, [this, &slot, doing] {
        WithinMemory(doing, [&] { directory_.Write(slot.encoded); });
      });
    });
  }

  static std::string Encoding(const Frame& frame) {
    return "writing frame " + std::to_string(frame.index) + " (" +
           std::to_string(frame.num_slots()) + " slots)";
  }

  const SequenceSpec& spec_;
  const BeginFrame& begin_frame_;
  const SequenceHooks& hooks_;
  SequenceDirectory& directory_;
  std::uint32_t next_;  ///< The frame that is begun next, counted from start_frame.
  bool is_over_ = false;
  std::vector<FrameSlot> slots_;
  std::future<void> writing_;
};

void MakeMissingFrames(const FramesAtOnce& at_once, MissingFrames& frames) {
  try {
    at_once.execute([&] { frames.Make(); });
  } catch (const RunStopped&) {
    // The frames before it are there.
  }
  frames.AwaitWriting();
}

}  // namespace

SequenceResult RunSequence(const SequenceSpec& spec,
                           const BeginFrame& begin_frame,
                           const SequenceHooks& hooks,
                           const FramesAtOnce& at_once) {
  SequenceDirectory directory(spec);
  SequenceResult result;
  result.num_resumed = directory.num_done();
  result.was_complete = directory.is_complete();
  if (!result.was_complete) {
    const auto begin = std::chrono::steady_clock::now();
    hooks.on_progress(directory.num_done(), spec.num_frames);
    MissingFrames frames(spec, begin_frame, hooks, at_once, directory);
    MakeMissingFrames(at_once, frames);
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
