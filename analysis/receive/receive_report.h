#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "railcast/io/stream.h"

namespace railcast {

/// Records a stream: frames/000000.pcd, ... in the order of arrival with every field that was sent,
/// and frames.csv with one line per file: file, run, frame, stamp_ns, the pose at the stamp (x y z
/// in m, qx qy qz qw), points, lost_points and, where points are in the sensor's axes, the time
/// from the stamp to the last firing and the pose at that.
class ReceivedFiles {
 public:
  /// @throws InputError if the directory cannot be made or already holds a recording.
  explicit ReceivedFiles(const std::filesystem::path& directory);

  /// @throws InputError if the file cannot be written.
  void Write(const ReceivedFrame& frame);

 private:
  std::filesystem::path directory_;
  std::ofstream lines_;
  std::uint32_t num_files_{};
};

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
