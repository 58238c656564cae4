#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/io/net/udp_sender.h"
#include "generator/live/live_run.h"

namespace railcast {

/// What the user reads after a live run: for each sensor frames, late ones and datagrams, and
/// quantiles of computing, sending and lateness.
/// @param delivered To its receivers, by sensor, as `records`.
/// @param has_times Whether the run's clock measured anything: one that jumps does not.
[[nodiscard]] std::string LiveSummary(const std::vector<LiveRecord>& records,
                                      const std::vector<UdpSender::Counts>& delivered,
                                      bool has_times);

/// "12.3 s, 123 frames, 0 late", of the first sensor's frames and all sensors' late ones; ", 4
/// dropped" and ", 3.2 s behind" if so: one line, without its end.
[[nodiscard]] std::string LiveProgress(const RunState& state);

}  // namespace railcast
