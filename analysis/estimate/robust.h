#pragma once

#include <vector>

#include "analysis/estimate/estimate.h"

namespace railcast {

/// From the median distance from the median to the standard deviation of normal samples.
inline constexpr double kMadToSigma = 1.4826;

/// The interval of a robust scale of `num` normal samples: chi-squared, with 37 % of them
/// (Rousseeuw and Croux 1993, JASA 88). Not enough below kMinSamples.
[[nodiscard]] Estimate RobustScaleEstimate(double scale, std::uint64_t num);

/// Ranks of order statistics, from 1.
struct RankInterval {
  std::uint64_t low{};
  std::uint64_t high{};
};

/// Those between which the true quantile lies with 95 %, for any distribution: how many of `num`
/// samples are below it is binomial (normal approximation).
[[nodiscard]] RankInterval QuantileRanks(std::uint64_t num, double share);

/// The median, with the interval between order statistics that holds for any distribution (David
/// and Nagaraja 2003, Order Statistics, 7.1). NaN is no sample; the order of `samples` is lost.
[[nodiscard]] Estimate Median(std::vector<double>& samples);

/// The figure of RobustScale() alone, of any number of samples; NaN of none. None may be NaN; their
/// values are lost.
[[nodiscard]] double PlainRobustScale(std::vector<double>& samples);

/// A robust standard deviation: 1.4826 x the median distance from the median, which up to half of
/// the samples cannot spoil. The interval is that of normal samples: 37 % as
/// efficient as the plain one (Rousseeuw and Croux 1993, JASA 88).
[[nodiscard]] Estimate RobustScale(std::vector<double>& samples);

}  // namespace railcast
