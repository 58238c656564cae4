#pragma once

#include <vector>

#include "analysis/estimate/estimate.h"

namespace railcast {

/// Factor from the median absolute deviation to the standard deviation of normal samples.
inline constexpr double kMadToSigma = 1.4826;

/// The interval of a robust scale of `num` normal samples: chi-squared, at an efficiency of 37 %
/// (Rousseeuw and Croux 1993, JASA 88). Not enough below kMinSamples.
[[nodiscard]] Estimate RobustScaleEstimate(double scale, std::uint64_t num);

/// Ranks of order statistics, counted from 1.
struct RankInterval {
  std::uint64_t low{};
  std::uint64_t high{};
};

/// The ranks between which the true quantile lies with 95 % confidence, for any distribution: the
/// number of the `num` samples below it is binomial (normal approximation).
[[nodiscard]] RankInterval QuantileRanks(std::uint64_t num, double share);

/// The median, with the distribution-free interval between order statistics (David and Nagaraja
/// 2003, Order Statistics, 7.1). NaN is ignored; the samples are reordered.
[[nodiscard]] Estimate Median(std::vector<double>& samples);

/// The value of RobustScale() alone, for any number of samples; NaN without samples.
/// @pre No sample is NaN. The contents of `samples` are overwritten.
[[nodiscard]] double PlainRobustScale(std::vector<double>& samples);

/// A robust standard deviation: 1.4826 x the median absolute deviation, which tolerates outliers in
/// up to half of the samples. The interval is that of normal samples, at 37 % of the efficiency of
/// the plain standard deviation (Rousseeuw and Croux 1993, JASA 88).
[[nodiscard]] Estimate RobustScale(std::vector<double>& samples);

}  // namespace railcast
