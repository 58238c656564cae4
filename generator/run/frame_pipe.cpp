#include "generator/run/frame_pipe.h"

#include <tbb/parallel_pipeline.h>

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "core/base/out_of_memory.h"
#include "generator/run/stopping.h"

namespace railcast {
namespace {

/// Writes frames on a thread of its own, in the order in which they come.
class WritingQueue {
 public:
  explicit WritingQueue(const FramePipe& pipe) : pipe_(pipe) {
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

  /// Waits until no more than `most` frames wait or are being written, and tells those that were.
  /// @throws What writing a frame has thrown. Nothing is written after that.
  void Await(std::size_t most) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return fault_ || waiting_.size() <= most; });
    const std::size_t num_written = num_written_;
    const std::exception_ptr fault = fault_;
    lock.unlock();
    for (; num_told_ < num_written; ++num_told_) pipe_.on_written();
    if (fault) std::rethrow_exception(fault);
  }
  /// Has a frame written, whose memory must stay as it is until then. Waits for room.
  void Put(std::size_t slot) {
    Await(pipe_.num_waiting - 1);
    {
      const std::lock_guard lock(mutex_);
      waiting_.push_back(slot);
    }
    changed_.notify_all();
  }

 private:
  void Run() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [&] { return is_ending_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      const std::size_t slot = waiting_.front();
      lock.unlock();
      std::exception_ptr fault;
      try {
        pipe_.write(slot);
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

  const FramePipe& pipe_;
  std::size_t num_told_ = 0;  ///< Written frames that were told.
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::size_t> waiting_;  ///< The first is being written.
  std::size_t num_written_ = 0;
  std::exception_ptr fault_;
  bool is_ending_ = false;
  std::thread thread_;
};

class PipeRun {
 public:
  explicit PipeRun(const FramePipe& pipe)
      : pipe_(pipe), faults_(pipe.num_slots()), writing_(pipe) {}

  void Run() {
    using tbb::filter_mode;
    auto way = tbb::make_filter<void, std::size_t>(
        filter_mode::serial_in_order, [this](tbb::flow_control& flow) { return Begin(flow); });
    for (const FramePipe::Stage& stage : pipe_.stages) {
      way &= tbb::make_filter<std::size_t, std::size_t>(
          stage.is_in_order ? filter_mode::serial_in_order : filter_mode::parallel,
          [this, &stage](std::size_t slot) {
            if (!faults_[slot]) Try(slot, stage.work);
            return slot;
          });
    }
    const auto all = way & tbb::make_filter<std::size_t, void>(
                               filter_mode::serial_in_order, [this](std::size_t slot) {
                                 if (faults_[slot]) writing_.Await(0);
                                 if (faults_[slot]) std::rethrow_exception(faults_[slot]);
                                 writing_.Put(slot);
                               });
    try {
      pipe_.execute([&] { tbb::parallel_pipeline(pipe_.num_at_once, all); });
    } catch (const RunStopped&) {
      // The frames before it are there.
    }
    writing_.Await(0);
  }

 private:
  std::size_t Begin(tbb::flow_control& flow) {
    const std::size_t slot = num_begun_++ % faults_.size();
    faults_[slot] = nullptr;
    Try(slot, [&](std::size_t) { is_over_ = is_over_ || !pipe_.begin(slot); });
    if (is_over_) flow.stop();
    // What could not be begun is passed on in its turn, after the frames before it.
    if (faults_[slot]) is_over_ = true;
    return slot;
  }

  template <typename Work>
  void Try(std::size_t slot, const Work& work) {
    try {
      work(slot);
    } catch (...) {
      faults_[slot] = std::current_exception();
    }
  }

  const FramePipe& pipe_;
  std::vector<std::exception_ptr> faults_;  ///< By slot: why there is no frame.
  std::size_t num_begun_ = 0;
  bool is_over_ = false;
  WritingQueue writing_;
};

}  // namespace

void RunPipe(const FramePipe& pipe) {
  PipeRun(pipe).Run();
}

}  // namespace railcast
