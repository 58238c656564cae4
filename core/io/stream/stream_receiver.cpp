#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "core/base/out_of_memory.h"
#include "core/io/net/udp.h"
#include "core/io/stream/frame_assembler.h"
#include "railcast/io/stream.h"

namespace railcast {
namespace {

constexpr int kSilence_ms = 1000;

}  // namespace

struct StreamReceiver::Parts {
  Parts(const Endpoint& listen_at, const WantedStream& wanted)
      : socket(listen_at),
        at(socket->at()),
        assembler(wanted),
        thread(StartThread("starting to listen at " + EndpointText(at), [this] { Listen(); })) {}

  void Stop();
  void Listen();
  void Queue(std::vector<ReceivedFrame>& frames);

  std::optional<UdpReceiver> socket;  ///< Absent once stopped.
  Endpoint at;
  std::atomic<bool> is_stopping{false};
  std::mutex mutex;  ///< Guards the members from here to has_ended.
  std::condition_variable changed;
  FrameAssembler assembler;
  std::deque<ReceivedFrame> waiting;
  std::uint64_t dropped_frames{};
  bool has_ended = false;   ///< Set when no further frame will be queued.
  std::mutex thread_mutex;  ///< Held by the caller that joins the thread.
  std::thread thread;
};

void StreamReceiver::Parts::Stop() {
  const std::lock_guard lock(thread_mutex);
  if (!socket) return;
  is_stopping = true;
  socket->Interrupt();
  thread.join();
  socket.reset();
}

void StreamReceiver::Parts::Listen() {
  using Clock = std::chrono::steady_clock;
  std::vector<ReceivedFrame> frames;
  auto last_heard = Clock::now();
  while (!is_stopping) {
    const auto received = socket->Receive(kSilence_ms);
    const auto now = Clock::now();
    const std::lock_guard lock(mutex);
    if (received) {
      last_heard = now;
      const std::chrono::nanoseconds time = now.time_since_epoch();
      const std::chrono::nanoseconds utc = std::chrono::system_clock::now().time_since_epoch();
      assembler.Take(received->bytes, frames, {received->from, time.count(), utc.count()});
    } else if (now - last_heard >= std::chrono::milliseconds(kSilence_ms)) {
      assembler.Flush(frames);
    }
    Queue(frames);
  }
  const std::lock_guard lock(mutex);
  assembler.Flush(frames);
  Queue(frames);
  has_ended = true;
  changed.notify_all();
}

void StreamReceiver::Parts::Queue(std::vector<ReceivedFrame>& frames) {
  if (frames.empty()) return;
  for (ReceivedFrame& frame : frames) {
    if (waiting.size() == kMaxWaitingFrames) {
      waiting.pop_front();
      ++dropped_frames;
    }
    waiting.push_back(std::move(frame));
  }
  frames.clear();
  changed.notify_all();
}

StreamReceiver::StreamReceiver(const Endpoint& at, const WantedStream& wanted)
    : parts_(std::make_unique<Parts>(at, wanted)) {}

StreamReceiver::~StreamReceiver() {
  Stop();
}

const Endpoint& StreamReceiver::at() const {
  return parts_->at;
}

void StreamReceiver::Stop() {
  parts_->Stop();
}

std::optional<ReceivedFrame> StreamReceiver::Next(int timeout_ms) {
  std::unique_lock lock(parts_->mutex);
  parts_->changed.wait_for(lock, std::chrono::milliseconds(timeout_ms),
                           [this] { return !parts_->waiting.empty() || parts_->has_ended; });
  if (parts_->waiting.empty()) return std::nullopt;
  ReceivedFrame frame = std::move(parts_->waiting.front());
  parts_->waiting.pop_front();
  return frame;
}

StreamReceiver::Counts StreamReceiver::counts() const {
  const std::lock_guard lock(parts_->mutex);
  return {parts_->assembler.counts(), parts_->dropped_frames};
}

}  // namespace railcast
