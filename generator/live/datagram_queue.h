#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "core/io/datagrams.h"
#include "core/program/duration_histogram.h"
#include "generator/live/live_clock.h"

namespace railcast {

/// The datagrams of one frame that is being sent.
struct OutgoingFrame {
  Datagrams datagrams;
  /// Offset from a datagram's `due_ns` to the clock's time at which it is to leave.
  std::int64_t clock_from_due_ns{};
  /// Whether all datagrams are sent together, as soon as possible.
  bool is_burst{};
  /// The clock's time after which a burst counts as late; absent = never.
  std::optional<std::int64_t> deadline_ns;
};

/// Statistics of what was sent for one sensor.
struct SentRecord {
  std::uint64_t datagrams{};
  std::uint64_t bytes{};
  std::uint64_t late_frames{};  ///< Frames sent after their deadlines.
  DurationHistogram send;       ///< Time spent in the sending calls, by frame.
  DurationHistogram lateness;   ///< Delay of each datagram after its due time.
};

/// Sends the frames of several sensors from a thread of its own, each datagram when it is due or
/// soon after, while the next frame is being made. With a clock that jumps there is no thread;
/// datagrams are then sent by SendUntil() and Flush(), exactly when they are due.
class DatagramQueue {
 public:
  using Send = std::function<void(const Datagrams&, std::span<const Datagrams::Item>)>;

  /// How long the thread rests after it sent, so that datagrams which become due meanwhile leave
  /// together: woken for each one of a dense scan, it would take a fifth of two processors from
  /// those who make the next frame.
  static constexpr std::int64_t kRest_ns = 1'000'000;
  /// It rests no longer than until this many are due, for which the buffers of receivers have room.
  static constexpr std::size_t kMostTogether = 32;

  /// @param send One function per sensor, called from the queue's thread.
  DatagramQueue(LiveClock& clock, std::vector<Send> send);
  /// Waits until all datagrams have been sent.
  ~DatagramQueue();
  DatagramQueue(const DatagramQueue&) = delete;
  DatagramQueue& operator=(const DatagramQueue&) = delete;

  /// Returns an empty frame with memory to reuse; waits while kMaxFrames of the sensor are being
  /// sent.
  /// @throws What `send` threw, if it did.
  [[nodiscard]] OutgoingFrame AcquireFrame(std::size_t sensor);
  void Put(std::size_t sensor, OutgoingFrame frame);

  /// With a clock that jumps: sends all datagrams due by then, each at its time. Otherwise does
  /// nothing.
  void SendUntil(std::int64_t time_ns);

  /// Waits until all datagrams have been sent.
  /// @throws What `send` threw, if it did.
  void Flush();

  /// @pre Flush() was the last call.
  [[nodiscard]] const SentRecord& record(std::size_t sensor) const { return lanes_[sensor].record; }

 private:
  // One being sent, one waiting for its turn, one being made.
  static constexpr int kMaxFrames = 3;

  struct Lane {
    Send send;
    std::deque<OutgoingFrame> waiting;  ///< The first one is being sent.
    std::vector<OutgoingFrame> spare;
    int num_frames = 0;    ///< Taken and not yet finished.
    std::size_t next = 0;  ///< Index of the first frame's next datagram.
    std::int64_t send_ns = 0;
    std::int64_t rested_ns = 0;  ///< When the thread has rested from the last sending.
    SentRecord record;
  };

  void Run();
  void SendNext(Lane& lane, std::unique_lock<std::mutex>& lock);
  [[nodiscard]] Lane* NextLane();
  /// When its next datagram is due, at the clock's time.
  [[nodiscard]] static std::int64_t DueNs(const Lane& lane);
  /// When the thread sends it.
  [[nodiscard]] static std::int64_t LeavesNs(const Lane& lane);
  void SendDue(Lane& lane, std::unique_lock<std::mutex>& lock);
  void Retire(Lane& lane);
  void ThrowIfFailed() const;

  LiveClock& clock_;
  std::vector<Lane> lanes_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace railcast
