#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "core/io/net/endpoint.h"
#include "core/io/net/udp_receiver.h"
#include "core/io/stream/frame_assembler.h"

namespace railcast {

/// Listens to a stream in the railcast protocol on a thread of its own.
///
/// A consumer that is too slow loses the oldest frames, never memory. After a second without a
/// datagram the frames that are still open are given as they are.
class StreamReceiver {
 public:
  static constexpr std::size_t kMaxWaitingFrames = 4;

  /// @throws InputError if the port cannot be listened to.
  explicit StreamReceiver(const Endpoint& at, const WantedStream& wanted = {});
  ~StreamReceiver();
  StreamReceiver(const StreamReceiver&) = delete;
  StreamReceiver& operator=(const StreamReceiver&) = delete;

  [[nodiscard]] const Endpoint& at() const { return at_; }

  /// The next frame; nothing after `timeout_ms` without one, or once stopped and emptied.
  [[nodiscard]] std::optional<ReceivedFrame> Next(int timeout_ms);
  /// Ends the listening and frees the port; frames that are still open wait as they are.
  /// Thread-safe.
  void Stop();

  struct Counts {
    StreamCounts stream;
    std::uint64_t dropped_frames{};  ///< That the consumer was too slow for.
  };
  /// Thread-safe.
  [[nodiscard]] Counts counts() const;

 private:
  void Listen();
  void Queue(std::vector<ReceivedFrame>& frames);

  std::optional<UdpReceiver> socket_;  ///< Gone once stopped.
  Endpoint at_;
  std::atomic<bool> is_stopping_{false};
  mutable std::mutex mutex_;  ///< Of all that follows.
  std::condition_variable changed_;
  FrameAssembler assembler_;
  std::deque<ReceivedFrame> waiting_;
  std::uint64_t dropped_frames_{};
  bool has_ended_ = false;   ///< No further frame will wait.
  std::mutex thread_mutex_;  ///< Of the thread: who joins it.
  std::thread thread_;
};

}  // namespace railcast
