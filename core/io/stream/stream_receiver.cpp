#include "core/io/stream/stream_receiver.h"

#include <chrono>
#include <utility>

#include "core/base/out_of_memory.h"

namespace railcast {
namespace {

constexpr int kSilence_ms = 1000;

}  // namespace

StreamReceiver::StreamReceiver(const Endpoint& at, const WantedStream& wanted)
    : socket_(at),
      at_(socket_->at()),
      assembler_(wanted),
      thread_(StartThread("starting to listen at " + EndpointText(at_), [this] { Listen(); })) {}

StreamReceiver::~StreamReceiver() {
  Stop();
}

void StreamReceiver::Stop() {
  const std::lock_guard lock(thread_mutex_);
  if (!socket_) return;
  is_stopping_ = true;
  socket_->Interrupt();
  thread_.join();
  socket_.reset();
}

void StreamReceiver::Listen() {
  using Clock = std::chrono::steady_clock;
  std::vector<ReceivedFrame> frames;
  auto last_heard = Clock::now();
  while (!is_stopping_) {
    const auto received = socket_->Receive(kSilence_ms);
    const auto now = Clock::now();
    const std::lock_guard lock(mutex_);
    if (received) {
      last_heard = now;
      const std::chrono::nanoseconds time = now.time_since_epoch();
      assembler_.Take(received->bytes, frames, {received->from, time.count()});
    } else if (now - last_heard >= std::chrono::milliseconds(kSilence_ms)) {
      assembler_.Flush(frames);
    }
    Queue(frames);
  }
  const std::lock_guard lock(mutex_);
  assembler_.Flush(frames);
  Queue(frames);
  has_ended_ = true;
  changed_.notify_all();
}

void StreamReceiver::Queue(std::vector<ReceivedFrame>& frames) {
  if (frames.empty()) return;
  for (ReceivedFrame& frame : frames) {
    if (waiting_.size() == kMaxWaitingFrames) {
      waiting_.pop_front();
      ++dropped_frames_;
    }
    waiting_.push_back(std::move(frame));
  }
  frames.clear();
  changed_.notify_all();
}

std::optional<ReceivedFrame> StreamReceiver::Next(int timeout_ms) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, std::chrono::milliseconds(timeout_ms),
                    [this] { return !waiting_.empty() || has_ended_; });
  if (waiting_.empty()) return std::nullopt;
  ReceivedFrame frame = std::move(waiting_.front());
  waiting_.pop_front();
  return frame;
}

StreamReceiver::Counts StreamReceiver::counts() const {
  const std::lock_guard lock(mutex_);
  return {assembler_.counts(), dropped_frames_};
}

}  // namespace railcast
