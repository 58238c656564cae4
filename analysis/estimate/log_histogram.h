#pragma once

#include <cstdint>
#include <vector>

#include "analysis/estimate/estimate.h"

namespace railcast {

/// Counts positive numbers in bins 1 % wide, so that quantiles of any number of samples need a
/// constant memory; they are exact to half a bin. Between 1e-7 and 1e5; what lies outside counts in
/// the end bins.
class LogHistogram {
 public:
  /// NaN is no sample.
  void Add(double sample);
  void Add(const LogHistogram& other);

  [[nodiscard]] std::uint64_t num() const { return num_; }
  /// With the interval between order statistics (see Median() in robust.h).
  [[nodiscard]] Estimate Median() const;
  /// @param share In [0, 1]; NaN without samples.
  [[nodiscard]] double Quantile(double share) const;

 private:
  [[nodiscard]] double OfRank(std::uint64_t rank) const;

  std::uint64_t num_{};
  std::vector<std::uint32_t> counts_;  ///< Empty until the first sample.
};

}  // namespace railcast
