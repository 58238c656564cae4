#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "railcast/io/stream.h"

namespace railcast {

/// Totals of the frames received, beside the receiver's own counts.
struct ReceivedTotals {
  std::uint64_t frames{};
  std::uint64_t points{};
  double first_s{};  ///< Arrival times of the first and the last frame.
  double last_s{};

  /// NaN before the second frame.
  [[nodiscard]] double rate_hz() const;
};

/// "50 frames, 16012 points each, 10.0 Hz, 0 packets lost".
[[nodiscard]] std::string ReceiveProgress(const ReceivedTotals& totals,
                                          const StreamReceiver::Counts& counts);

/// After what a run ends, if anything ends it but a signal.
struct ReceiveLimits {
  std::optional<std::uint64_t> num_frames;
  std::optional<double> duration_s;
};

/// The completed share of a run, by whichever limit is nearer; nothing if it has none.
[[nodiscard]] std::optional<double> ReceivedShare(const ReceivedTotals& totals,
                                                  double elapsed_s,
                                                  const ReceiveLimits& limits);

/// Lines on frames, packets and points and, where there are any, on datagrams of other senders and
/// on refused ones by reason.
[[nodiscard]] std::string ReceiveSummary(const ReceivedTotals& totals,
                                         const StreamReceiver::Counts& counts);

/// The same as JSON, in one line.
[[nodiscard]] std::string ReceiveSummaryJson(const ReceivedTotals& totals,
                                             const StreamReceiver::Counts& counts);

}  // namespace railcast
