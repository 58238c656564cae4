#include "generator/sequence/run_sequence.h"

#include <tbb/parallel_pipeline.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
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

std::string Writing(const Frame& frame) {
  return "writing frame " + std::to_string(frame.index) + " (" + std::to_string(frame.num_slots()) +
         " slots)";
}

/// Writes frames on a thread of its own, in the order in which they come.
class WritingQueue {
 public:
  /// @param most Number of frames that may wait or be written at a time.
  WritingQueue(SequenceDirectory& directory, std::size_t most)
      : directory_(directory), most_(most) {
    thread_ = StartThread("writing frames", [this] { Run(); });
  }
  ~WritingQueue() {
    {
      const std::lock_guard lock(mutex_);
      is_ending_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  WritingQueue(const WritingQueue&) = delete;
  WritingQueue& operator=(const WritingQueue&) = delete;

  /// Waits until no more than `most` frames wait or are being written.
  /// @return How many have been written so far.
  /// @throws What writing a frame has thrown. Nothing is written after that.
  std::uint32_t Await(std::size_t most) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return fault_ || waiting_.size() <= most; });
    if (fault_) std::rethrow_exception(fault_);
    return num_written_;
  }
  /// Has a frame written, whose memory must stay as it is until then. Waits for room.
  std::uint32_t Put(const FrameSlot& slot) {
    const std::uint32_t num_written = Await(most_ - 1);
    {
      const std::lock_guard lock(mutex_);
      waiting_.push_back(&slot);
    }
    changed_.notify_all();
    return num_written;
  }

 private:
  void Run() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [&] { return is_ending_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      const FrameSlot& slot = *waiting_.front();
      lock.unlock();
      std::exception_ptr fault;
      try {
        WithinMemory([&] { return Writing(slot.made.frame); },
                     [&] { directory_.Write(slot.encoded); });
      } catch (...) {
        fault = std::current_exception();
      }
      lock.lock();
      fault_ = fault;
      changed_.notify_all();
      if (fault) return;
      waiting_.pop_front();
      ++num_written_;
    }
  }

  SequenceDirectory& directory_;
  std::size_t most_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<const FrameSlot*> waiting_;  ///< The first is being written.
  std::uint32_t num_written_ = 0;
  std::exception_ptr fault_;
  bool is_ending_ = false;
  std::thread thread_;
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
        num_at_once_(at_once.num),
        num_resumed_(directory.num_done()),
        num_shown_(directory.num_done()),
        next_(directory.num_done()),
        // The pipeline holds as many frames as are made at once, and as many are being written.
        slots_(2 * at_once.num),
        writing_(directory, at_once.num) {}

  /// Makes frames until there is none left, or the run is stopped.
  void Make() {
    tbb::parallel_pipeline(
        num_at_once_,
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

  /// Waits for the frames that are being written.
  void AwaitWriting() { ShowProgress(writing_.Await(0)); }

 private:
  // Returns null if no frame is left.
  FrameSlot* Begin() {
    if (is_over_ || next_ >= spec_.num_frames || hooks_.is_stopped()) return nullptr;
    FrameSlot& slot = slots_[next_ % slots_.size()];
    slot.fault = nullptr;
    try {
      slot.job = begin_frame_(spec_.FrameAt(next_));
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
      const auto doing = [&made] { return Writing(made.frame); };
      WithinMemory(doing, [&] {
        directory_.Encode(made.frame, made.objects, made.has_image ? &made.image : nullptr,
                          slot.encoded);
      });
    } catch (...) {
      slot.fault = std::current_exception();
    }
  }

  void Write(const FrameSlot& slot) {
    if (slot.fault) {
      AwaitWriting();
      std::rethrow_exception(slot.fault);
    }
    ShowProgress(writing_.Put(slot));
  }

  void ShowProgress(std::uint32_t num_written) {
    while (num_shown_ < num_resumed_ + num_written) {
      hooks_.on_progress(++num_shown_, spec_.num_frames);
    }
  }

  const SequenceSpec& spec_;
  const BeginFrame& begin_frame_;
  const SequenceHooks& hooks_;
  SequenceDirectory& directory_;
  std::size_t num_at_once_;
  std::uint32_t num_resumed_;
  std::uint32_t num_shown_;  ///< As on_progress() was told last.
  std::uint32_t next_;       ///< Which of the run's frames is begun next.
  bool is_over_ = false;
  std::vector<FrameSlot> slots_;
  WritingQueue writing_;  // Last, so that it ends before the memory that it writes.
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
