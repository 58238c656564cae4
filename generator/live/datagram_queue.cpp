#include "generator/live/datagram_queue.h"

#include <sys/prctl.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/out_of_memory.h"

namespace railcast {

DatagramQueue::DatagramQueue(LiveClock& clock, std::vector<Send> send)
    : clock_(clock), lanes_(send.size()) {
  for (std::size_t i = 0; i < send.size(); ++i) lanes_[i].send = std::move(send[i]);
  if (!clock.jumps()) thread_ = StartThread("starting to send", [this] { Run(); });
}

DatagramQueue::~DatagramQueue() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

OutgoingFrame DatagramQueue::AcquireFrame(std::size_t sensor) {
  std::unique_lock lock(mutex_);
  Lane& lane = lanes_[sensor];
  while (clock_.jumps() && lane.num_frames == kMaxFrames) SendNext(lane, lock);
  changed_.wait(lock, [&] { return lane.num_frames < kMaxFrames || failure_; });
  ThrowIfFailed();
  ++lane.num_frames;
  if (lane.spare.empty()) return {};
  OutgoingFrame frame = std::move(lane.spare.back());
  lane.spare.pop_back();
  return frame;
}

void DatagramQueue::Put(std::size_t sensor, OutgoingFrame frame) {
  {
    const std::lock_guard lock(mutex_);
    lanes_[sensor].waiting.push_back(std::move(frame));
  }
  changed_.notify_all();
}

void DatagramQueue::SendUntil(std::int64_t time_ns) {
  if (!clock_.jumps()) return;
  std::unique_lock lock(mutex_);
  for (Lane* lane = NextLane(); lane != nullptr && DueNs(*lane) <= time_ns; lane = NextLane()) {
    SendNext(*lane, lock);
  }
}

void DatagramQueue::SendNext(Lane& lane, std::unique_lock<std::mutex>& lock) {
  clock_.WaitUntil(DueNs(lane), changed_, lock);
  SendDue(lane, lock);
}

void DatagramQueue::Flush() {
  SendUntil(std::numeric_limits<std::int64_t>::max());
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] {
    return failure_ || std::all_of(lanes_.begin(), lanes_.end(),
                                   [](const Lane& lane) { return lane.waiting.empty(); });
  });
  ThrowIfFailed();
}

void DatagramQueue::ThrowIfFailed() const {
  if (failure_) std::rethrow_exception(failure_);
}

std::int64_t DatagramQueue::DueNs(const Lane& lane) {
  const OutgoingFrame& frame = lane.waiting.front();
  // A frame without datagrams is finished as soon as it arrives.
  if (frame.is_burst || lane.next == frame.datagrams.items.size()) {
    return frame.clock_from_due_ns;
  }
  return frame.clock_from_due_ns + frame.datagrams.items[lane.next].due_ns;
}

std::int64_t DatagramQueue::LeavesNs(const Lane& lane) {
  const std::int64_t due_ns = DueNs(lane);
  const OutgoingFrame& frame = lane.waiting.front();
  const auto& items = frame.datagrams.items;
  if (frame.is_burst || lane.next == items.size()) return due_ns;
  const std::size_t last = std::min(lane.next + kMostTogether, items.size()) - 1;
  return std::max(due_ns, std::min(lane.rested_ns, frame.clock_from_due_ns + items[last].due_ns));
}

DatagramQueue::Lane* DatagramQueue::NextLane() {
  Lane* next = nullptr;
  for (Lane& lane : lanes_) {
    if (lane.waiting.empty()) continue;
    if (next == nullptr || LeavesNs(lane) < LeavesNs(*next)) next = &lane;
  }
  return next;
}

void DatagramQueue::Run() {
  // Wakes within microseconds of the requested time; Linux's default timer slack is 50 us.
  ::prctl(PR_SET_TIMERSLACK, 1UL);
  std::unique_lock lock(mutex_);
  while (true) {
    Lane* lane = NextLane();
    if (lane == nullptr) {
      if (stopping_) return;
      changed_.wait(lock);
      continue;
    }
    const std::int64_t leaves_ns = LeavesNs(*lane);
    if (clock_.NowNs() < leaves_ns) {
      clock_.WaitUntil(leaves_ns, changed_, lock);
      continue;  // A frame that arrived meanwhile may be due earlier.
    }
    try {
      SendDue(*lane, lock);
    } catch (...) {
      if (!lock.owns_lock()) lock.lock();
      failure_ = std::current_exception();
      changed_.notify_all();
      return;
    }
  }
}

void DatagramQueue::SendDue(Lane& lane, std::unique_lock<std::mutex>& lock) {
  // Only this function uses the first frame, so it can be sent while other threads append theirs.
  // Growing a deque at its end does not move its elements.
  OutgoingFrame& frame = lane.waiting.front();
  const auto& items = frame.datagrams.items;
  const std::int64_t begin_ns = clock_.NowNs();
  std::size_t end = lane.next;
  while (end < items.size() &&
         (frame.is_burst || frame.clock_from_due_ns + items[end].due_ns <= begin_ns)) {
    ++end;
  }
  const auto due = std::span(items).subspan(lane.next, end - lane.next);
  if (!due.empty()) {
    lock.unlock();
    lane.send(frame.datagrams, due);
    lock.lock();
  }
  const std::int64_t end_ns = clock_.NowNs();
  lane.send_ns += end_ns - begin_ns;
  if (!clock_.jumps()) lane.rested_ns = begin_ns + kRest_ns;
  for (const Datagrams::Item& item : due) {
    lane.record.lateness.Add(end_ns - frame.clock_from_due_ns - (frame.is_burst ? 0 : item.due_ns));
    lane.record.bytes += item.size;
  }
  lane.record.datagrams += due.size();
  lane.next = end;
  if (end < items.size()) return;
  if (frame.deadline_ns && end_ns > *frame.deadline_ns) ++lane.record.late_frames;
  Retire(lane);
}

void DatagramQueue::Retire(Lane& lane) {
  lane.record.send.Add(lane.send_ns);
  lane.send_ns = 0;
  lane.next = 0;
  lane.waiting.front().datagrams.Clear();
  lane.spare.push_back(std::move(lane.waiting.front()));
  lane.waiting.pop_front();
  --lane.num_frames;
  changed_.notify_all();
}

}  // namespace railcast
