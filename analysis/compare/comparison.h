#pragma once

#include <functional>
#include <string>
#include <vector>

#include "analysis/compare/distance_bins.h"
#include "analysis/compare/histogram.h"
#include "analysis/compare/pairing.h"
#include "analysis/estimate/moments.h"

namespace railcast {

/// A figure that is computed for every pair of frames.
struct PairMetric {
  std::string key;    ///< "chamfer_m"
  std::string title;  ///< "Chamfer distance"
  std::string unit;
};

/// All metrics, in the order of PairFigures::values.
[[nodiscard]] std::vector<PairMetric> PairMetrics(const std::vector<double>& distances_m);

/// The figures of one pair of frames.
struct PairFigures {
  std::uint32_t index_a{}, index_b{};
  std::int64_t stamp_a_ns{}, stamp_b_ns{};
  std::uint64_t num_points_a{}, num_points_b{};
  std::vector<double> values;  ///< NaN where a frame has no points or lacks the field.
};

/// Compares two recordings pair by pair. Its size hardly grows with their length.
class Comparison {
 public:
  explicit Comparison(std::vector<double> distances_m);

  /// The input of Add(), which can be computed on any thread.
  struct Part {
    PairFigures figures;
    CloudHistograms histograms_a, histograms_b;
    BinnedCloud bins_a, bins_b;
  };
  [[nodiscard]] Part Compare(const RecordedFrame& a, const RecordedFrame& b) const;
  void Add(const Part& part);

  [[nodiscard]] const std::vector<PairMetric>& metrics() const { return metrics_; }
  [[nodiscard]] const std::vector<double>& distances_m() const { return distances_m_; }
  [[nodiscard]] std::uint64_t num_pairs() const { return num_pairs_; }

  /// One metric over all pairs.
  struct Summary {
    Moments moments;
    double sum{};
    double least = std::numeric_limits<double>::infinity();
    double largest = -std::numeric_limits<double>::infinity();
    /// Plain mean of the pairs that have the metric, without an interval; NaN if none has it.
    [[nodiscard]] double Mean() const;
  };
  [[nodiscard]] const std::vector<Summary>& summaries() const { return summaries_; }
  /// Every pair or, in long recordings, every pair_stride()-th one.
  [[nodiscard]] const std::vector<PairFigures>& pairs() const { return pairs_; }
  [[nodiscard]] std::uint64_t pair_stride() const { return stride_; }
  [[nodiscard]] const CloudHistograms& histograms_a() const { return histograms_a_; }
  [[nodiscard]] const CloudHistograms& histograms_b() const { return histograms_b_; }
  [[nodiscard]] const BinSums& bins() const { return bins_; }

 private:
  std::vector<double> distances_m_;
  std::vector<PairMetric> metrics_;
  std::vector<Summary> summaries_;
  std::vector<PairFigures> pairs_;
  std::uint64_t num_pairs_{}, stride_ = 1;
  CloudHistograms histograms_a_, histograms_b_;
  BinSums bins_;
};

/// Called after each pair, on one thread at a time.
using ComparisonProgress = std::function<void(std::uint64_t num_pairs)>;

/// Compares all pairs, several at a time; the figures do not depend on the number of threads.
/// @throws InputError as the recordings do.
void CompareAll(FramePairs& pairs, Comparison& comparison, const ComparisonProgress& on_progress);

}  // namespace railcast
