#include "analysis/estimate/robust.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>

namespace railcast {
namespace {

constexpr double kTail = 0.5 * (1.0 - kConfidence);
constexpr double kMadToSigma = 1.4826;
constexpr double kMadEfficiency = 0.3675;

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

}  // namespace

RankInterval MedianRanks(std::uint64_t num) {
  const double z = boost::math::quantile(boost::math::normal(), 1.0 - kTail);
  const auto n = static_cast<double>(num);
  const double reach = 0.5 * z * std::sqrt(n);
  return {static_cast<std::uint64_t>(std::max(1.0, std::floor(0.5 * n - reach))),
          static_cast<std::uint64_t>(std::min(n, std::ceil(0.5 * n + reach) + 1.0))};
}

Estimate Median(std::vector<double>& samples) {
  std::erase_if(samples, [](double sample) { return std::isnan(sample); });
  if (samples.size() < kMinSamples) return NotEnough(samples.size());
  const RankInterval ranks = MedianRanks(samples.size());
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

Estimate RobustScale(std::vector<double>& samples) {
  std::erase_if(samples, [](double sample) { return std::isnan(sample); });
  if (samples.size() < kMinSamples) return NotEnough(samples.size());
  const double degrees = kMadEfficiency * (static_cast<double>(samples.size()) - 1.0);
  std::vector<double> distances = samples;
  const double scale = PlainRobustScale(distances);
  const boost::math::chi_squared distribution(degrees);
  return {scale, scale * std::sqrt(degrees / boost::math::quantile(distribution, 1.0 - kTail)),
          scale * std::sqrt(degrees / boost::math::quantile(distribution, kTail)), samples.size()};
}

}  // namespace railcast
