#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "analysis/compare/cloud.h"
#include "analysis/estimate/moments.h"

namespace railcast {

/// Number of points and intensities of a cloud in each of RangeBins() (analysis/stats/bins.h).
struct BinnedCloud {
  struct Bin {
    std::uint64_t num_points{};
    std::uint64_t num_intensities{};
    double intensity_sum{};

    /// NaN where fewer than kMinSamples points have an intensity.
    [[nodiscard]] double MeanIntensity() const;
  };
  std::vector<Bin> bins;
};

[[nodiscard]] BinnedCloud BinnedByRange(const ComparedCloud& cloud);

/// Mean absolute percentage errors of B against A: the mean over bins of |B - A| / A, in percent
/// (Haider et al. 2022, Sensors 22(19) 7556, for a target at several distances). Bins in which A
/// has fewer than kMinSamples points take no part; NaN if none does.
struct BinErrors {
  double points = std::numeric_limits<double>::quiet_NaN();
  double intensity = std::numeric_limits<double>::quiet_NaN();
};

[[nodiscard]] BinErrors ErrorsOf(const BinnedCloud& a, const BinnedCloud& b);

/// Sums over pairs of frames, bin by bin.
class BinSums {
 public:
  struct Bin {
    Moments points_a, points_b;        ///< Per frame.
    Moments intensity_a, intensity_b;  ///< Mean intensities of the frames.
    Moments points_change;             ///< (B - A) / A, where A has enough points.
    Moments intensity_change;          ///< (B - A) / A of the mean intensity.
  };

  BinSums();
  void Add(const BinnedCloud& a, const BinnedCloud& b);
  [[nodiscard]] const std::vector<Bin>& bins() const { return bins_; }
  /// The errors of the sums over all frames.
  [[nodiscard]] BinErrors Errors() const { return ErrorsOf(sum_a_, sum_b_); }

 private:
  std::vector<Bin> bins_;
  BinnedCloud sum_a_, sum_b_;
};

}  // namespace railcast
