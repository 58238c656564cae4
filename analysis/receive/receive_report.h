#pragma once

#include <cstdint>
#include <string>

#include "core/io/stream/stream_receiver.h"

namespace railcast {

/// What came in, besides the receiver's own counts.
struct ReceivedTotals {
  std::uint64_t frames{};
  std::uint64_t points{};
  double first_s{};  ///< When the first frame was there, and the last one.
  double last_s{};

  /// NaN before the second frame.
  [[nodiscard]] double rate_hz() const;
};

/// "50 frames, 16012 points each, 10.0 Hz, 0 packets lost".
[[nodiscard]] std::string ReceiveProgress(const ReceivedTotals& totals,
                                          const StreamReceiver::Counts& counts);

/// Lines of frames, packets, points; and of what others sent and what was refused, by reason, if
/// anything was.
[[nodiscard]] std::string ReceiveSummary(const ReceivedTotals& totals,
                                         const StreamReceiver::Counts& counts);

}  // namespace railcast
