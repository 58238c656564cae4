#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace railcast {

/// The clock that a live run follows.
class LiveClock {
 public:
  virtual ~LiveClock() = default;

  /// Returns nanoseconds since an arbitrary epoch; never decreases.
  [[nodiscard]] virtual std::int64_t NowNs() const = 0;
  /// Waits for `changed`, at most until `time_ns`.
  virtual void WaitUntil(std::int64_t time_ns,
                         std::condition_variable& changed,
                         std::unique_lock<std::mutex>& lock) = 0;
  /// Whether time passes only by waiting. A run then has a single thread and takes no longer than
  /// its computations.
  [[nodiscard]] virtual bool jumps() const = 0;
};

/// The machine's monotonic clock.
class MonotonicClock final : public LiveClock {
 public:
  [[nodiscard]] std::int64_t NowNs() const override;
  void WaitUntil(std::int64_t time_ns,
                 std::condition_variable& changed,
                 std::unique_lock<std::mutex>& lock) override;
  [[nodiscard]] bool jumps() const override { return false; }
};

/// A clock that jumps to whatever time is waited for.
class JumpingClock final : public LiveClock {
 public:
  [[nodiscard]] std::int64_t NowNs() const override { return now_ns_; }
  void WaitUntil(std::int64_t time_ns,
                 std::condition_variable& changed,
                 std::unique_lock<std::mutex>& lock) override;
  [[nodiscard]] bool jumps() const override { return true; }
  void JumpTo(std::int64_t time_ns);

 private:
  std::int64_t now_ns_ = 0;
};

}  // namespace railcast
