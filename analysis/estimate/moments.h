#pragma once

#include <cstdint>

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

}  // namespace railcast
