#include "analysis/estimate/robust.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/estimate/estimate.h"

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

}  // namespace

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

}  // namespace railcast
