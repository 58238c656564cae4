#pragma once

#include <cstdint>
#include <optional>

namespace railcast {

/// When what was recorded is to be sent: as long after the beginning as in the recording, or in a
/// share of that.
///
/// Where recorded times go back by up to a second, as network cards that have several queues note
/// them, what is late is sent at once. Where they go back further, a clock was set or recordings
/// were put together: what follows is sent at once, and the times count on from there. Pauses are
/// kept.
class ReplayTimes {
 public:
  static constexpr std::int64_t kOvertaken_ns = 1'000'000'000;

  /// @param pace How many times faster than recorded; above 0.
  explicit ReplayTimes(double pace) : pace_(pace) {}

  /// Returns when what was recorded at a time is to be sent: 0 for the first, and never less than
  /// before.
  [[nodiscard]] std::int64_t Of(std::int64_t recorded_ns);
  /// Returns how long a duration in the recording takes.
  [[nodiscard]] std::int64_t Lasting(std::int64_t duration_ns) const;

 private:
  double pace_;
  std::optional<std::int64_t> latest_ns_;  ///< The latest recorded time.
  double since_ns_{};                      ///< When that is sent.
};

}  // namespace railcast
