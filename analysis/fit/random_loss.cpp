#include "analysis/fit/random_loss.h"

#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <functional>
#include <vector>

namespace railcast {
namespace {

using Exponents = std::array<double, 2>;  ///< {a, rate}, where P(point) = exp(-(a + rate R)).

/// Root of a falling function of x > 0; 0 if the function is negative from the beginning.
double Crossing(const std::function<double(double)>& falling, double guess) {
  constexpr double kNothing = 1e-12;
  if (falling(kNothing) <= 0.0) return 0.0;
  constexpr double kFactor = 4.0;
  std::uintmax_t max_steps = 200;
  const auto [low, high] = boost::math::tools::bracket_and_solve_root(
      falling, std::max(guess, 1e-9), kFactor, false, boost::math::tools::eps_tolerance<double>(40),
      max_steps);
  return 0.5 * (low + high);
}

class Likelihood {
 public:
  explicit Likelihood(const std::map<int, LossBin>& bins) {
    for (const auto& [metre, bin] : bins) bins_.push_back(bin);
  }

  [[nodiscard]] double At(const Exponents& value) const {
    double sum = 0.0;
    for (const LossBin& bin : bins_) {
      const double exponent = ExponentOf(bin, value);
      sum += static_cast<double>(bin.num_lost) * std::log(-std::expm1(-exponent)) -
             static_cast<double>(bin.num - bin.num_lost) * exponent;
    }
    return sum;
  }

  /// Derivative of the log likelihood with respect to one of the two exponents.
  [[nodiscard]] double Slope(const Exponents& value, std::size_t which) const {
    double sum = 0.0;
    for (const LossBin& bin : bins_) {
      const double by_exponent =
          static_cast<double>(bin.num_lost) / std::expm1(ExponentOf(bin, value)) -
          static_cast<double>(bin.num - bin.num_lost);
      sum += (which == 0 ? 1.0 : bin.range_m()) * by_exponent;
    }
    return sum;
  }

  /// Fixes one exponent and maximises over the other.
  [[nodiscard]] Exponents Best(std::size_t fixed, double x) const {
    Exponents value{};
    value[fixed] = x;
    value[1 - fixed] = Crossing(
        [&](double y) {
          Exponents tried = value;
          tried[1 - fixed] = y;
          return Slope(tried, 1 - fixed);
        },
        1e-3);
    return value;
  }

 private:
  [[nodiscard]] static double ExponentOf(const LossBin& bin, const Exponents& value) {
    // Positive, since a loss is never impossible.
    return std::max(1e-12, value[0] + value[1] * bin.range_m());
  }

  std::vector<LossBin> bins_;
};

Estimate FitProfile(const Likelihood& likelihood, std::size_t which, std::uint64_t num) {
  // The slope of the profile is that of the likelihood: the derivative by the other exponent is 0,
  // or that exponent is at its bound.
  const double best =
      Crossing([&](double x) { return likelihood.Slope(likelihood.Best(which, x), which); }, 1e-3);
  const double least = likelihood.At(likelihood.Best(which, best)) -
                       0.5 * boost::math::quantile(boost::math::chi_squared(1.0), kConfidence);
  const auto margin = [&](double x) { return likelihood.At(likelihood.Best(which, x)) - least; };
  Estimate estimate{best, 0.0, 0.0, num};
  if (margin(0.0) < 0.0) {
    estimate.low =
        best - Crossing([&](double less) { return margin(std::max(0.0, best - less)); }, best);
  }
  estimate.high = best + Crossing([&](double more) { return margin(best + more); }, best);
  return estimate;
}

}  // namespace

double RandomLoss::At(double range_m) const {
  return 1.0 - (1.0 - probability.value) * std::exp(-rate_per_m.value * range_m);
}

RandomLoss FitRandomLoss(const std::map<int, LossBin>& bins) {
  std::uint64_t num = 0;
  std::uint64_t num_lost = 0;
  for (const auto& [metre, bin] : bins) {
    num += bin.num;
    num_lost += bin.num_lost;
  }
  // If every firing was lost, the likelihood grows with the rate without bound.
  if (num < kMinSamples || num_lost == num) return {NotEnough(num), NotEnough(num)};
  const Likelihood likelihood(bins);
  const auto share = [](double exponent) { return -std::expm1(-exponent); };
  const Estimate a = FitProfile(likelihood, 0, num);
  return {{share(a.value), share(a.low), share(a.high), num}, FitProfile(likelihood, 1, num)};
}

}  // namespace railcast
