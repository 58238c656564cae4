#pragma once

#include <cstdint>
#include <vector>

#include "analysis/estimate/estimate.h"

namespace railcast {

/// Mean and standard deviation of a stream of numbers, in constant memory (Welford 1962). Partial
/// results can be merged (Chan, Golub and LeVeque 1979).
class Moments {
 public:
  /// NaN is ignored.
  void Add(double sample);
  void Add(const Moments& other);

  [[nodiscard]] std::uint64_t num() const { return num_; }
  /// Mean of any number of samples, without an interval; NaN without samples.
  [[nodiscard]] double PlainMean() const;
  /// Mean with Student's interval: exact for normal samples, a good approximation for many samples
  /// of any distribution.
  [[nodiscard]] Estimate Mean() const;
  /// Root of the unbiased variance, with the chi-squared interval, which holds for normal samples
  /// only.
  [[nodiscard]] Estimate StandardDeviation() const;

 private:
  std::uint64_t num_{};
  double mean_{};
  double squares_{};  ///< Sum of squared distances from the mean.
};

/// Counts numbers in bins 1 % wide, so that medians of any number of samples need a constant
/// memory; they are exact to half a bin. Magnitudes below 1e-7 count as 0; those beyond 1e9 in the
/// last bin.
class LogHistogram {
 public:
  /// NaN is ignored.
  void Add(double sample);
  void Add(const LogHistogram& other);

  [[nodiscard]] std::uint64_t num() const { return num_; }
  /// With the interval between order statistics (see Median() in estimate.h).
  /// @param share Between 0 and 1.
  [[nodiscard]] Estimate Quantile(double share) const;
  [[nodiscard]] Estimate Median() const { return Quantile(0.5); }
  /// See RobustScale() in estimate.h.
  [[nodiscard]] Estimate RobustScale() const;
  /// The overload for samples that came in steps; if they did not, it is as RobustScale().
  [[nodiscard]] Estimate RobustScale(double step, RoundedValues rounded) const;

 private:
  [[nodiscard]] double OfRank(std::uint64_t rank) const;

  std::uint64_t num_{};
  std::uint64_t num_zeros_{};
  std::vector<std::uint32_t> positive_, negative_;  ///< By magnitude; empty until the first sample.
};

}  // namespace railcast
