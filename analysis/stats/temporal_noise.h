#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "analysis/stats/sums.h"
#include "core/io/recording/scan_table.h"
#include "railcast/io/recording.h"

namespace railcast {

/// Whether the sensor was elsewhere, or looked elsewhere, in the later frame.
/// @pre Both have a pose.
[[nodiscard]] bool HasMoved(const RecordedFrame& earlier, const RecordedFrame& later);

/// Range noise from what changes between two frames of a sensor that stands.
///
/// Firings of the same ring with azimuths less than half a column apart are paired, and the range
/// is corrected for the slope between them; only places that are flat enough for that (neighbours
/// within 0.3 m of a straight line) take part. sigma = standard deviation of the differences /
/// sqrt(2). Pairs of frames do not overlap, so that their samples are independent. What moves in
/// the scene spoils the plain figure and not the robust one.
class TemporalNoise {
 public:
  /// Adds two consecutive frames.
  /// @param scan Of `later` (of both, where the pattern is fixed); null if it is not a grid.
  void Add(const RecordedFrame& earlier,
           const RecordedFrame& later,
           const ScanTable* earlier_scan,
           const ScanTable* later_scan);
  static auto Sums(auto& of) {
    return std::tie(of.num_pairs_, of.num_moved_, of.num_without_pose_, of.bins_);
  }

  /// Differences in one bin of range.
  struct Bin {
    Scatter differences_m;

    static auto Sums(auto& of) { return std::tie(of.differences_m); }
    [[nodiscard]] Estimate Sigma_m() const;
    [[nodiscard]] Estimate RobustSigma_m() const;
  };

  [[nodiscard]] std::uint64_t num_pairs() const { return num_pairs_; }
  [[nodiscard]] std::uint64_t num_moved() const { return num_moved_; }
  /// By bin of RangeBins(); empty without pairs.
  [[nodiscard]] const std::vector<Bin>& bins() const { return bins_; }
  [[nodiscard]] Section MakeSection() const;

 private:
  std::uint64_t num_pairs_{};  ///< Pairs of frames that took part.
  std::uint64_t num_moved_{};  ///< Pairs of frames between which the sensor moved.
  /// Pairs without a pose among num_pairs_, for which the sensor is assumed to stand still.
  std::uint64_t num_without_pose_{};
  std::vector<Bin> bins_;
};

}  // namespace railcast
