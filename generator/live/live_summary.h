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

/// "12.3 s, 123 frames, 0 late": one line, without its end.
[[nodiscard]] std::string LiveProgress(std::int64_t stamp_ns,
                                       std::uint64_t frames,
                                       std::uint64_t late_frames);

}  // namespace railcast
