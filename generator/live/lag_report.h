#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "generator/live/live_run.h"

namespace railcast {

/// Reports, while a run goes on, that it cannot keep up: once its frames begin a second too late or
/// frames are dropped, and then at most every ten seconds while that lasts.
class LagReport {
 public:
  static constexpr std::int64_t kLag_ns = 1'000'000'000;
  static constexpr std::int64_t kPause_ns = 10'000'000'000;

  /// @param drops_late Whether the run drops late frames. The report then counts dropped frames
  ///   instead of stating how far behind the run is.
  explicit LagReport(bool drops_late) : drops_late_(drops_late) {}

  /// Returns what is to be reported now, which is usually nothing: "cannot keep up: 3.2 s behind
  /// after 12.3 s, 80 of 91 frames late; --drop-late drops frames instead" or "cannot keep up: 37
  /// of 128 frames dropped after 12.3 s".
  [[nodiscard]] std::optional<std::string> After(const RunState& state);

 private:
  bool drops_late_;
  std::uint64_t num_dropped_ = 0;  ///< Number of dropped frames at the last report.
  std::optional<std::int64_t> said_ns_;
};

}  // namespace railcast
