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
#include "generator/live/duration_histogram.h"
#include "generator/live/live_clock.h"

namespace railcast {

/// The datagrams of one frame on their way out.
struct OutgoingFrame {
  Datagrams datagrams;
  /// From a datagram's `due_ns` to the clock's time at which it leaves.
  std::int64_t clock_from_due_ns{};
  /// All leave at once, as soon as they can.
  bool is_burst{};
  /// The clock's time at which a burst must have left not to be late; absent = it never is.
  std::optional<std::int64_t> deadline_ns;
};

/// What has left of one sensor.
struct SentRecord {
  std::uint64_t datagrams{};
  std::uint64_t bytes{};
  std::uint64_t late_frames{};  ///< After their deadlines.
  DurationHistogram send;       ///< Time in the sending calls, by frame.
  DurationHistogram lateness;   ///< From when a datagram should leave to when it did.
};

/// Sends the frames of several sensors from a thread of its own, each datagram when it is due: the
/// next frame is made meanwhile. Where the clock jumps it has no thread and sends when it is asked.
class DatagramQueue {
 public:
  using Send = std::function<void(const Datagrams&, std::span<const Datagrams::Item>)>;

  /// @param send By sensor. Called from the queue's thread.
  DatagramQueue(LiveClock& clock, std::vector<Send> send);
  /// Waits until all has left.
  ~DatagramQueue();
  DatagramQueue(const DatagramQueue&) = delete;
  DatagramQueue& operator=(const DatagramQueue&) = delete;

  /// An empty frame with memory to reuse; waits while kMaxFrames of the sensor are on their way.
  /// @throws What `send` threw, if it did.
  [[nodiscard]] OutgoingFrame Take(std::size_t sensor);
  void Put(std::size_t sensor, OutgoingFrame frame);

  /// Where the clock jumps: sends all that is due by then, at its time. Else does nothing.
  void SendUntil(std::int64_t time_ns);

  /// Waits until everything has left. @throws What `send` threw, if it did.
  void Flush();

  /// @pre Flush() was called last.
  [[nodiscard]] const SentRecord& record(std::size_t sensor) const { return lanes_[sensor].record; }

 private:
  // One that leaves, one that waits for its turn, one in the making.
  static constexpr int kMaxFrames = 3;

  struct Lane {
    Send send;
    std::deque<OutgoingFrame> waiting;  ///< The first is on its way.
    std::vector<OutgoingFrame> spare;
    int num_frames = 0;    ///< Taken and not yet gone.
    std::size_t next = 0;  ///< Datagram of the first.
    std::int64_t send_ns = 0;
    SentRecord record;
  };

  void Run();
  void SendNext(Lane& lane, std::unique_lock<std::mutex>& lock);
  [[nodiscard]] Lane* NextLane();
  [[nodiscard]] static std::int64_t DueNs(const Lane& lane);
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
