#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <mutex>

#include "core/base/units.h"
#include "railcast/enum_names.h"
#include "railcast/scenario.h"

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

/// The time that stamps of live frames state.
enum class StampClock {
  kSimulated,  ///< Simulation time.
  kUtc,        ///< The time of day.
  kTai,        ///< The same in atomic time, which grandmasters of PTP tell.
};
template <>
inline constexpr auto kEnumNames<StampClock> = std::to_array<EnumName<StampClock>>(
    {{StampClock::kSimulated, "simulated"}, {StampClock::kUtc, "utc"}, {StampClock::kTai, "tai"}});

/// By how much TAI is ahead of UTC since the last leap second, that of 2016 (IERS, Bulletin C 52).
inline constexpr std::int64_t kTaiAhead_ns = 37 * kNsPerS;

/// Whether the sensors whose packets a protocol has follow PTP (IEEE 1588): Hesai's state what the
/// grandmaster tells, as their manuals say, and Ouster's do with TIME_FROM_PTP_1588. Velodyne's are
/// sent as they are by GPS, and nodes of ROS 2 follow the clock of their machine.
[[nodiscard]] constexpr bool FollowsPtp(Protocol protocol) {
  return protocol >= Protocol::kPandar64 && protocol <= Protocol::kOuster;
}

}  // namespace railcast
