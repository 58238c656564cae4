#include "generator/live/live_clock.h"

#include <algorithm>
#include <chrono>

namespace railcast {

std::int64_t MonotonicClock::NowNs() const {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void MonotonicClock::WaitUntil(std::int64_t time_ns,
                               std::condition_variable& changed,
                               std::unique_lock<std::mutex>& lock) {
  const std::chrono::steady_clock::time_point time{std::chrono::nanoseconds(time_ns)};
  changed.wait_until(lock, time);
}

void JumpingClock::WaitUntil(std::int64_t time_ns,
                             std::condition_variable& /*changed*/,
                             std::unique_lock<std::mutex>& /*lock*/) {
  JumpTo(time_ns);
}

void JumpingClock::JumpTo(std::int64_t time_ns) {
  now_ns_ = std::max(now_ns_, time_ns);
}

}  // namespace railcast
