#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/rounded_scale.h"

namespace railcast {

/// With fewer samples a figure is only given as "not enough".
inline constexpr std::uint64_t kMinSamples = 10;
/// Confidence level of every interval in the reports.
inline constexpr double kConfidence = 0.95;
/// Probability beyond each end of an interval.
inline constexpr double kTail = 0.5 * (1.0 - kConfidence);

/// A figure, its 95 % confidence interval, and the number of samples it rests on. Value and both
/// ends are NaN if there were not enough samples.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t num{};

  [[nodiscard]] bool is_enough() const { return !std::isnan(value); }
};

/// An estimate that is "not enough": it only has the number of samples.
[[nodiscard]] inline Estimate NotEnough(std::uint64_t num) {
  Estimate estimate;
  estimate.num = num;
  return estimate;
}

/// Converts an estimate to another unit.
[[nodiscard]] inline Estimate Scaled(const Estimate& estimate, double factor) {
  return {estimate.value * factor, estimate.low * factor, estimate.high * factor, estimate.num};
}

/// A share in percent; NaN of nothing.
[[nodiscard]] inline double Percent(std::uint64_t part, std::uint64_t whole) {
  if (whole == 0) return std::numeric_limits<double>::quiet_NaN();
  return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

/// The share of `num` independent trials that succeeded, with Wilson's score interval (Wilson 1927,
/// JASA 22), which stays in [0, 1] and holds at 0 and `num` successes.
[[nodiscard]] Estimate Proportion(std::uint64_t num_successes, std::uint64_t num);

/// As Proportion(), in percent, which is the unit of all shares in reports.
[[nodiscard]] inline Estimate PercentProportion(std::uint64_t num_successes, std::uint64_t num) {
  return Scaled(Proportion(num_successes, num), 100.0);
}

/// The rate of a Poisson count: `count` per `exposure`, with the exact interval (Garwood 1936,
/// Biometrika 28); not enough below kMinSamples and without exposure.
[[nodiscard]] Estimate PoissonRate(std::uint64_t count, double exposure);

/// As PoissonRate() for any number of counts, even none: the interval is exact. Not enough without
/// exposure only.
[[nodiscard]] Estimate ExactPoissonRate(std::uint64_t count, double exposure);

/// Number of standard errors that a two-sided 95 % interval of a normal quantity reaches to each
/// side.
[[nodiscard]] double NormalQuantile();
/// As NormalQuantile() for a quantity whose error was estimated with so many degrees of freedom.
[[nodiscard]] double StudentQuantile(double degrees);
/// The quantile of chi-squared below which this share lies.
[[nodiscard]] double ChiSquared(double degrees, double share);

/// Standard deviation of normal samples, estimated with so many degrees of freedom, with its
/// chi-squared interval.
/// @param num Number of samples that the estimate states.
[[nodiscard]] Estimate ScaleEstimate(double scale, double degrees, std::uint64_t num);

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

/// The same of samples that come in steps, before they were rounded: by their middle half where the
/// steps are finer than half of it, else by maximum likelihood (core/base/rounded_scale.h).
[[nodiscard]] Estimate RobustScale(const RoundedSamples& samples, RoundedValues rounded);

/// A standard deviation less what rounding to a step adds to its square, a twelfth of the step's.
/// Where all values fall into one step it adds nothing: the interval's upper end stays.
[[nodiscard]] Estimate WithoutRounding(const Estimate& sigma, double step);

/// A point of a curve: y at x, with the relative standard error of y (1 / sqrt(count)
/// for a count).
struct CurvePoint {
  double x{};
  double y{};
  double relative_error{};
};

/// y = factor x^exponent.
struct PowerLaw {
  Estimate exponent;  ///< Its num is the number of points that took part.
  double factor{};

  /// y at x on the fitted line; not enough where the exponent is not.
  [[nodiscard]] Estimate At(double x) const;

  // The quantities from which At() computes its interval.
  double middle{};  ///< Weighted mean of log x.
  double
      /// Half the interval of log y there, which is independent of that of the exponent.
      middle_error{};
};

/// Fits a straight line through (log x, log y), weighted by 1 / relative_error^2.
/// The interval is Student's, from the points' scatter about the line or from
/// their own errors, whichever is wider. Points whose x or y is not > 0 are ignored; fewer than
/// kMinCurvePoints are not enough.
[[nodiscard]] PowerLaw FitPowerLaw(const std::vector<CurvePoint>& points);

inline constexpr std::size_t kMinCurvePoints = 4;

/// Where the value lies that 90 % of a population exceed, each side with 95 % confidence.
struct ToleranceLimits {
  double low = std::numeric_limits<double>::quiet_NaN();   ///< NaN with fewer than 29 values.
  double high = std::numeric_limits<double>::quiet_NaN();  ///< NaN with fewer than 2 values.
};

/// The limits by the ranks of a sample, whatever its distribution (Wilks 1941, Annals of
/// Mathematical Statistics 12): the k-th smallest value is a lower limit if fewer than k of n
/// values lie below the true one in at most 5 % of all samples, so that 29 values all exceed it, 46
/// all but one, 61 all but two.
///
///   const double d90_95_m = LimitsExceededBy90Percent(detected_m).low;
///
/// @param values Independent of each other; of what never happened, any value below all others.
[[nodiscard]] ToleranceLimits LimitsExceededBy90Percent(std::vector<double> values);

}  // namespace railcast
