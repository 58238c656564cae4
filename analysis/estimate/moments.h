#pragma once

#include <cstdint>

#include "analysis/estimate/estimate.h"

namespace railcast {

/// Mean and standard deviation of a stream of numbers, in constant memory (Welford 1962). Sums of
/// parts add up to those of the whole (Chan, Golub and LeVeque 1979).
class Moments {
 public:
  /// NaN is no sample.
  void Add(double sample);
  void Add(const Moments& other);

  [[nodiscard]] std::uint64_t num() const { return num_; }
  /// Of any number of samples, without an interval; NaN of none.
  [[nodiscard]] double PlainMean() const;
  /// With Student's interval: exact for normal samples, good for many of any kind.
  [[nodiscard]] Estimate Mean() const;
  /// Unbiased variance's root, with the chi-squared interval: for normal samples only.
  [[nodiscard]] Estimate StandardDeviation() const;

 private:
  std::uint64_t num_{};
  double mean_{};
  double squares_{};  ///< Sum of squared distances from the mean.
};

}  // namespace railcast
