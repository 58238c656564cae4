#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "core/program/duration_histogram.h"
#include "railcast/io/stream.h"

namespace railcast {

/// Records a stream: frames/000000.pcd, ... in the order of arrival with every field that was sent,
/// and frames.csv with one line per file: file, run, frame, stamp_ns, the pose at the stamp (x y z
/// in m, qx qy qz qw), points, lost_points; where points are in the sensor's axes, the time from
/// the stamp to the last firing and the pose at that; the times at which the frame's first and last
/// datagram arrived, and LatencyOf() it.
class ReceivedFiles {
 public:
  /// @throws InputError if the directory cannot be made or already holds a recording; as
  ///   RefuseLinks().
  explicit ReceivedFiles(const std::filesystem::path& directory);

  /// @throws InputError if the file cannot be written.
  void Write(const ReceivedFrame& frame);

 private:
  std::filesystem::path directory_;
  std::ofstream lines_;
  std::uint32_t num_files_{};
};

/// Returns the time from a frame's last firing to the arrival of its last datagram, below 0 where
/// the sender's clock is ahead. Nothing if its stamp is no time of day, which one is that differs
/// from the arrival by an hour at most.
[[nodiscard]] std::optional<std::int64_t> LatencyOf(const ReceivedFrame& frame);

/// Totals of the frames received, beside the receiver's own counts.
struct ReceivedTotals {
  std::uint64_t frames{};
  std::uint64_t points{};
  double first_s{};  ///< Arrival times of the first and the last frame.
  double last_s{};
  std::optional<std::int64_t> last_arrival_ns;  ///< When the last frame arrived.
  DurationHistogram between;     ///< From the arrival of each frame to that of the next.
  DurationHistogram latency;     ///< LatencyOf() the frames that have one, 0 if it is below that.
  std::uint64_t frames_ahead{};  ///< Frames whose LatencyOf() is below 0.

  /// Adds what is known of a frame, but for `first_s` and `last_s`.
  void Add(const ReceivedFrame& frame);
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

/// Lines on frames, packets, points and times of arrival and, where there are any, on datagrams of
/// other senders and on refused ones by reason.
[[nodiscard]] std::string ReceiveSummary(const ReceivedTotals& totals,
                                         const StreamReceiver::Counts& counts);

/// The same as JSON, in one line.
[[nodiscard]] std::string ReceiveSummaryJson(const ReceivedTotals& totals,
                                             const StreamReceiver::Counts& counts);

}  // namespace railcast
