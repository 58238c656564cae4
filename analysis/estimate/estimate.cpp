#include "analysis/estimate/estimate.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "core/base/error.h"

namespace railcast {
namespace {

double ChiSquared(double degrees, double share) {
  return boost::math::quantile(boost::math::chi_squared(degrees), share);
}

}  // namespace

double NormalQuantile() {
  return boost::math::quantile(boost::math::normal(), 1.0 - kTail);
}

double StudentQuantile(double degrees) {
  return boost::math::quantile(boost::math::students_t(degrees), 1.0 - kTail);
}

Estimate ScaleEstimate(double scale, double degrees, std::uint64_t num) {
  const boost::math::chi_squared distribution(degrees);
  return {scale, scale * std::sqrt(degrees / boost::math::quantile(distribution, 1.0 - kTail)),
          scale * std::sqrt(degrees / boost::math::quantile(distribution, kTail)), num};
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
  if (count < kMinSamples || !(exposure > 0.0)) return NotEnough(count);
  const auto n = static_cast<double>(count);
  const double low = 0.5 * ChiSquared(2.0 * n, kTail);
  const double high = 0.5 * ChiSquared(2.0 * n + 2.0, 1.0 - kTail);
  return {n / exposure, low / exposure, high / exposure, count};
}

}  // namespace railcast
