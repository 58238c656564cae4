#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "analysis/compare/cloud.h"

namespace railcast {

/// Counts by bin; only bins with a count are stored.
class Histogram {
 public:
  Histogram() = default;
  /// Each element adds one count to its bin.
  explicit Histogram(std::vector<std::int64_t> bins);

  void Add(const Histogram& other);
  [[nodiscard]] std::uint64_t num() const { return num_; }
  /// Ascending by bin.
  [[nodiscard]] const std::vector<std::pair<std::int64_t, std::uint64_t>>& counts() const {
    return counts_;
  }

 private:
  std::vector<std::pair<std::int64_t, std::uint64_t>> counts_;
  std::uint64_t num_{};
};

/// Jensen-Shannon divergence of two histograms as distributions, in bits: 0 for equal ones, 1 for
/// disjoint ones (Lin 1991, IEEE Trans. Inf. Theory 37; base 2). NaN if either is empty.
[[nodiscard]] double JensenShannonDivergence(const Histogram& a, const Histogram& b);

/// The quantities that are compared as histograms.
struct CloudHistograms {
  Histogram range;  ///< Bins of 1 m.
  /// Bins of an eighth octave (9 % wide); everything up to 0.001 is in one bin.
  Histogram intensity;
  Histogram ring;  ///< One bin per ring.
  /// Bird's-eye occupancy: a cell of 1 m x 1 m counts once per frame if it holds any point.
  Histogram occupancy;

  void Add(const CloudHistograms& other);
};

[[nodiscard]] CloudHistograms HistogramsOf(const ComparedCloud& cloud);

/// The middle of a bin of CloudHistograms::intensity.
[[nodiscard]] double IntensityOfBin(std::int64_t bin);

}  // namespace railcast
