#include "analysis/estimate/estimate.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cstddef>
#include <utility>

#include "core/base/error.h"

namespace railcast {
namespace {

double Nth(std::vector<double>& samples, std::size_t n) {
  const auto place = samples.begin() + static_cast<std::ptrdiff_t>(n);
  std::nth_element(samples.begin(), place, samples.end());
  return *place;
}

// @pre samples is not empty.
double PlainMedian(std::vector<double>& samples) {
  const std::size_t half = samples.size() / 2;
  const double upper = Nth(samples, half);
  if (samples.size() % 2 == 1) return upper;
  const double lower =
      *std::max_element(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(half));
  return 0.5 * (lower + upper);
}

/// The standard deviation, in steps, of the normal law that has as wide a middle half as samples
/// that are counted by steps. Between the edges of steps, normal quantiles are interpolated.
double SpreadInSteps(const RoundedSamples& samples) {
  const boost::math::normal normal;
  std::vector<std::pair<double, double>> edges;  // The quantile of the share below, and the place.
  double below = 0.0;
  const auto add = [&](double place) {
    if (!edges.empty() && !(place > edges.back().second)) return;
    const double share = std::clamp(below, 0.5, samples.num - 0.5) / samples.num;
    edges.emplace_back(boost::math::quantile(normal, share), place);
  };
  for (const auto& [steps, count] : samples.by_steps) {
    add(static_cast<double>(steps) - 0.5);
    below += count;
    add(static_cast<double>(steps) + 0.5);
  }
  const double quartile = boost::math::quantile(normal, 0.75);
  const auto place_of = [&](double quantile) {
    const auto above = std::ranges::lower_bound(edges, std::pair(quantile, 0.0));
    if (above == edges.begin() || above == edges.end()) return 0.0;
    const auto& [from, place] = *std::prev(above);
    return std::lerp(place, above->second, (quantile - from) / (above->first - from));
  };
  return (place_of(quartile) - place_of(-quartile)) / (2.0 * quartile);
}

}  // namespace

double NormalQuantile() {
  return boost::math::quantile(boost::math::normal(), 1.0 - kTail);
}

double StudentQuantile(double degrees) {
  return boost::math::quantile(boost::math::students_t(degrees), 1.0 - kTail);
}

double ChiSquared(double degrees, double share) {
  return boost::math::quantile(boost::math::chi_squared(degrees), share);
}

Estimate ScaleEstimate(double scale, double degrees, std::uint64_t num) {
  return {scale, scale * std::sqrt(degrees / ChiSquared(degrees, 1.0 - kTail)),
          scale * std::sqrt(degrees / ChiSquared(degrees, kTail)), num};
}

Estimate Proportion(std::uint64_t num_successes, std::uint64_t num) {
  Check(num_successes <= num, "no more successes than trials");
  if (num < kMinSamples) return NotEnough(num);
  const double z = NormalQuantile();
  const auto n = static_cast<double>(num);
  const double p = static_cast<double>(num_successes) / n;
  const double shrink = 1.0 / (1.0 + z * z / n);
  const double middle = shrink * (p + z * z / (2.0 * n));
  const double half = shrink * z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
  // At the ends the formula is exact except for rounding.
  return {p, num_successes == 0 ? 0.0 : middle - half, num_successes == num ? 1.0 : middle + half,
          num};
}

Estimate PoissonRate(std::uint64_t count, double exposure) {
  return count < kMinSamples ? NotEnough(count) : ExactPoissonRate(count, exposure);
}

Estimate ExactPoissonRate(std::uint64_t count, double exposure) {
  if (!(exposure > 0.0)) return NotEnough(count);
  const auto n = static_cast<double>(count);
  const double low = count == 0 ? 0.0 : 0.5 * ChiSquared(2.0 * n, kTail);
  const double high = 0.5 * ChiSquared(2.0 * n + 2.0, 1.0 - kTail);
  return {n / exposure, low / exposure, high / exposure, count};
}

RankInterval QuantileRanks(std::uint64_t num, double share) {
  const double z = NormalQuantile();
  const auto n = static_cast<double>(num);
  const double reach = z * std::sqrt(n * share * (1.0 - share));
  return {static_cast<std::uint64_t>(std::max(1.0, std::floor(n * share - reach))),
          static_cast<std::uint64_t>(std::min(n, std::ceil(n * share + reach) + 1.0))};
}

Estimate Median(std::vector<double>& samples) {
  std::erase_if(samples, [](double sample) { return std::isnan(sample); });
  if (samples.size() < kMinSamples) return NotEnough(samples.size());
  const RankInterval ranks = QuantileRanks(samples.size(), 0.5);
  const double low = Nth(samples, ranks.low - 1);
  const double high = Nth(samples, ranks.high - 1);
  return {PlainMedian(samples), low, high, samples.size()};
}

double PlainRobustScale(std::vector<double>& samples) {
  if (samples.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double median = PlainMedian(samples);
  for (double& sample : samples) sample = std::abs(sample - median);
  return kMadToSigma * PlainMedian(samples);
}

Estimate RobustScaleEstimate(double scale, std::uint64_t num) {
  constexpr double kMadEfficiency = 0.3675;
  if (num < kMinSamples) return NotEnough(num);
  return ScaleEstimate(scale, kMadEfficiency * (static_cast<double>(num) - 1.0), num);
}

Estimate RobustScale(std::vector<double>& samples) {
  std::erase_if(samples, [](double sample) { return std::isnan(sample); });
  std::vector<double> distances = samples;
  return RobustScaleEstimate(PlainRobustScale(distances), samples.size());
}

Estimate RobustScale(const RoundedSamples& samples, RoundedValues rounded) {
  const auto num = static_cast<std::uint64_t>(samples.num);
  if (num < kMinSamples) return NotEnough(num);
  constexpr double kCoarse = 0.5;  // Share of the spread: coarser steps shape the samples' law.
  const double spread = SpreadInSteps(samples);
  if (kCoarse * spread > 1.0) {
    const double off_steps =
        rounded == RoundedValues::kOne ? 0.0 : 1.0 - samples.num_on_steps / samples.num;
    const double rounding = (1.0 + std::clamp(off_steps, 0.0, 1.0)) / 12.0;
    return RobustScaleEstimate(samples.step * std::sqrt(spread * spread - rounding), num);
  }
  const RoundedScale scale = FindRoundedScale({samples}, rounded);
  return {scale.value, scale.low, scale.high, num};
}

Estimate WithoutRounding(const Estimate& sigma, double step) {
  const auto less = [&](double of, double share) {
    return std::sqrt(std::max(0.0, of * of - share * step * step));
  };
  // The median of errors that are not quite normal is off by up to a hundredth.
  constexpr double kMost = 1.1 / 12.0;
  if (!sigma.is_enough() || !(step > 0.0)) return sigma;
  return {less(sigma.value, 1.0 / 12.0), less(sigma.low, kMost), sigma.high, sigma.num};
}

ToleranceLimits LimitsExceededBy90Percent(std::vector<double> values) {
  constexpr double kShareBelow = 0.1;
  constexpr double kRisk = 0.05;
  std::ranges::sort(values);
  const boost::math::binomial below(static_cast<double>(values.size()), kShareBelow);
  ToleranceLimits limits;
  for (std::size_t i = 0; i < values.size(); ++i) {
    // The probability that at most i values lie below the one that is sought.
    const double probability = boost::math::cdf(below, static_cast<double>(i));
    if (probability <= kRisk) limits.low = values[i];
    if (probability >= 1.0 - kRisk) {
      limits.high = values[i];
      break;
    }
  }
  return limits;
}

PowerLaw FitPowerLaw(const std::vector<CurvePoint>& points) {
  std::vector<CurvePoint> logs;
  for (const CurvePoint& point : points) {
    if (!(point.x > 0.0 && point.y > 0.0 && point.relative_error > 0.0)) continue;
    logs.push_back({std::log(point.x), std::log(point.y), point.relative_error});
  }
  PowerLaw law;
  law.exponent = NotEnough(logs.size());
  if (logs.size() < kMinCurvePoints) return law;

  double sum = 0.0, mean_x = 0.0, mean_y = 0.0;
  const auto weight = [](const CurvePoint& p) {
    return 1.0 / (p.relative_error * p.relative_error);
  };
  for (const CurvePoint& p : logs) {
    sum += weight(p);
    mean_x += weight(p) * p.x;
    mean_y += weight(p) * p.y;
  }
  mean_x /= sum;
  mean_y /= sum;
  double xx = 0.0, xy = 0.0;
  for (const CurvePoint& p : logs) {
    xx += weight(p) * (p.x - mean_x) * (p.x - mean_x);
    xy += weight(p) * (p.x - mean_x) * (p.y - mean_y);
  }
  if (!(xx > 0.0)) return law;
  const double slope = xy / xx;
  double scatter = 0.0;  // Chi-squared.
  for (const CurvePoint& p : logs) {
    const double residual = p.y - mean_y - slope * (p.x - mean_x);
    scatter += weight(p) * residual * residual;
  }
  const double degrees = static_cast<double>(logs.size()) - 2.0;
  const double times = StudentQuantile(degrees) * std::sqrt(std::max(1.0, scatter / degrees));
  const double half = times / std::sqrt(xx);
  law.exponent = {slope, slope - half, slope + half, logs.size()};
  law.factor = std::exp(mean_y - slope * mean_x);
  law.middle = mean_x;
  law.middle_error = times / std::sqrt(sum);
  return law;
}

Estimate PowerLaw::At(double x) const {
  if (!exponent.is_enough()) return exponent;
  const double y = factor * std::pow(x, exponent.value);
  const double by_slope = (std::log(x) - middle) * 0.5 * (exponent.high - exponent.low);
  const double grow = std::exp(std::hypot(middle_error, by_slope));
  return {y, y / grow, y * grow, exponent.num};
}

}  // namespace railcast
