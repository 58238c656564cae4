#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "analysis/estimate/streams.h"
#include "analysis/report/report.h"
#include "railcast/io/recording.h"

namespace railcast {

/// Velocities along the beams, of sensors that measure them: how many points have one, which ones
/// there are, and how far they are from the truth where frames have it.
class Velocity {
 public:
  /// Frames without velocities are skipped.
  void Add(const RecordedFrame& recorded);
  void Add(const Velocity& other);

  /// The points in one bin of range.
  struct Sum {
    std::uint64_t num_points{};
    Moments measured_mps;
    /// Measured less true velocity, of points that have both.
    Moments errors_mps;
    LogHistogram robust_errors_mps;

    void Add(const Sum& other);
  };

  [[nodiscard]] bool is_empty() const { return by_range_.empty(); }
  /// By bin of RangeBins(), of the measured range.
  [[nodiscard]] const std::vector<Sum>& by_range() const { return by_range_; }
  /// Whether any frame held the truth.
  [[nodiscard]] bool has_truth() const { return has_truth_; }
  /// Points by velocity, in bins of kVelocityBin_mps: bin 2 begins at twice that.
  [[nodiscard]] const std::map<std::int64_t, std::uint64_t>& distribution() const {
    return distribution_;
  }
  [[nodiscard]] Section MakeSection() const;

 private:
  bool has_truth_{};
  std::vector<Sum> by_range_;
  std::map<std::int64_t, std::uint64_t> distribution_;
};

inline constexpr double kVelocityBin_mps = 2.0;

}  // namespace railcast
