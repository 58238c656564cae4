#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "analysis/compare/cloud.h"

namespace railcast {

/// How many of a kind fell into each bin; only bins with any are kept.
class Histogram {
 public:
  Histogram() = default;
  /// Each element one count.
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

/// Jensen-Shannon divergence of two histograms as distributions, in bits: 0 = the same, 1 = nothing
/// in common (Lin 1991, IEEE Trans. Inf. Theory 37; base 2). NaN if either is empty.
[[nodiscard]] double JensenShannonDivergence(const Histogram& a, const Histogram& b);

/// What is compared as histograms.
struct CloudHistograms {
  Histogram range;      ///< Bins of 1 m.
  Histogram intensity;  ///< Bins of an eighth octave (9 % wide); all up to 0.001 in one.
  Histogram ring;       ///< One bin a ring.
  /// Bird's-eye occupancy: a cell of 1 m x 1 m counts once a frame if it holds any point.
  Histogram occupancy;

  void Add(const CloudHistograms& other);
};

[[nodiscard]] CloudHistograms HistogramsOf(const ComparedCloud& cloud);

/// The middle of a bin of CloudHistograms::intensity.
[[nodiscard]] double IntensityOfBin(std::int64_t bin);

}  // namespace railcast
