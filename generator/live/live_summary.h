#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/net/udp.h"
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

/// Returns the report after a live run: for each sensor the numbers of frames, late frames and
/// datagrams, and quantiles of the times for computing and sending and of the lateness.
/// @param delivered Datagrams delivered to receivers, by sensor, as `records`.
/// @param has_times Whether the run's clock measures time; one that jumps does not.
[[nodiscard]] std::string LiveSummary(const std::vector<LiveRecord>& records,
                                      const std::vector<UdpSender::Counts>& delivered,
                                      bool has_times);

/// Returns the same as JSON, in one line, with what ended the run or its captures early. Times are
/// null where the clock does not measure them.
/// @param command The command that was run.
[[nodiscard]] std::string LiveSummaryJson(std::string_view command,
                                          const LiveResult& result,
                                          const std::vector<UdpSender::Counts>& delivered,
                                          const std::vector<std::string>& capture_faults,
                                          bool has_times);

/// Returns "12 of 80 frames late, 4 dropped" over all sensors; empty if there was neither.
[[nodiscard]] std::string LateText(const std::vector<LiveRecord>& records);

/// Returns "12.3 s, 123 frames, 0 late", counting the first sensor's frames and all sensors' late
/// ones, followed by ", 4 dropped" and ", 3.2 s behind" where that applies: one line, without its
/// end.
[[nodiscard]] std::string LiveProgress(const RunState& state);

}  // namespace railcast
