#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/io/net/udp.h"
#include "generator/live/live_run.h"

namespace railcast {

/// Returns the report after a live run: for each sensor the numbers of frames, late frames and
/// datagrams, and quantiles of the times for computing and sending and of the lateness.
/// @param delivered Datagrams delivered to receivers, by sensor, as `records`.
/// @param has_times Whether the run's clock measures time; one that jumps does not.
[[nodiscard]] std::string LiveSummary(const std::vector<LiveRecord>& records,
                                      const std::vector<UdpSender::Counts>& delivered,
                                      bool has_times);

/// Returns the same as JSON, in one line, with what ended the run or its captures early. Times are
/// null where the clock does not measure them.
[[nodiscard]] std::string LiveSummaryJson(const LiveResult& result,
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
