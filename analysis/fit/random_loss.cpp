#include "analysis/fit/random_loss.h"

#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <functional>

namespace railcast {
namespace {

/// Trials at about the same range.
struct Bin {
  double returned{};
  double lost{};
  std::array<double, 2> design{1.0, 0.0};  ///< What offset and rate are multiplied with: 1, R.
};

// In hundreds by range: the loss hardly varies within.
std::vector<Bin> BinTrials(std::vector<StrongTrial> trials) {
  constexpr std::size_t kNumBins = 400;
  std::stable_sort(trials.begin(), trials.end(), [](const StrongTrial& a, const StrongTrial& b) {
    return a.range_m < b.range_m;
  });
  const std::size_t num_bins = std::min(kNumBins, trials.size());
  std::vector<Bin> bins(num_bins);
  for (std::size_t b = 0; b < num_bins; ++b) {
    const std::size_t begin = trials.size() * b / num_bins;
    const std::size_t end = trials.size() * (b + 1) / num_bins;
    for (std::size_t i = begin; i < end; ++i) {
      (trials[i].is_returned ? bins[b].returned : bins[b].lost) += 1.0;
      bins[b].design[1] += trials[i].range_m / static_cast<double>(end - begin);
    }
  }
  return bins;
}

using Exponents = std::array<double, 2>;  // a, rate

double ExponentOf(const Bin& bin, const Exponents& value) {
  // A lost beam is never impossible.
  return std::max(1e-12, value[0] * bin.design[0] + value[1] * bin.design[1]);
}

double LogLikelihood(const std::vector<Bin>& bins, const Exponents& value) {
  double sum = 0.0;
  for (const Bin& bin : bins) {
    const double exponent = ExponentOf(bin, value);
    sum -= bin.returned * exponent;
    if (bin.lost > 0.0) sum += bin.lost * std::log(-std::expm1(-exponent));
  }
  return sum;
}

double Slope(const std::vector<Bin>& bins, const Exponents& value, std::size_t which) {
  double sum = 0.0;
  for (const Bin& bin : bins) {
    const double by_exponent = bin.lost / std::expm1(ExponentOf(bin, value)) - bin.returned;
    sum += bin.design[which] * by_exponent;
  }
  return sum;
}

// Where a falling function of x >= 0 crosses 0; 0 if it is negative there already.
double Crossing(const std::function<double(double)>& falling, double guess) {
  if (falling(0.0) <= 0.0) return 0.0;
  double low = 0.0;
  double high = std::max(guess, 1e-9);
  constexpr int kDoublings = 60;
  for (int i = 0; i < kDoublings && falling(high) > 0.0; ++i) {
    low = high;
    high *= 2.0;
  }
  constexpr int kHalvings = 50;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (falling(middle) > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// The likelihood as a function of one of the two, the other at its best.
class Profile {
 public:
  Profile(const std::vector<Bin>& bins, std::size_t which, double guess)
      : bins_(bins), which_(which), guess_(guess) {}

  [[nodiscard]] Estimate Fit(std::uint64_t num) const {
    // The slope of the profile is that of the likelihood: the other's is 0 or it stands at its
    // edge.
    const double best = Crossing([&](double x) { return Slope(bins_, At(x), which_); }, guess_);
    const double highest = LogLikelihood(bins_, At(best));
    const double drop = 0.5 * boost::math::quantile(boost::math::chi_squared(1.0), kConfidence);
    const auto is_within = [&](double x) { return LogLikelihood(bins_, At(x)) - highest + drop; };
    Estimate estimate{best, 0.0, 0.0, num};
    if (is_within(0.0) < 0.0) {
      estimate.low =
          best - Crossing([&](double less) { return is_within(std::max(0.0, best - less)); }, best);
    }
    estimate.high = best + Crossing([&](double more) { return is_within(best + more); }, best);
    return estimate;
  }

 private:
  // Both, the other at its best for this.
  [[nodiscard]] Exponents At(double x) const {
    Exponents value{};
    value[which_] = x;
    const std::size_t other = 1 - which_;
    value[other] = Crossing(
        [&](double y) {
          Exponents tried = value;
          tried[other] = y;
          return Slope(bins_, tried, other);
        },
        1e-3);
    return value;
  }

  const std::vector<Bin>& bins_;
  std::size_t which_;
  double guess_;
};

double ShareOf(double exponent) {
  return -std::expm1(-exponent);
}

}  // namespace

RandomLoss RandomLossFit::loss() const {
  return {probability.is_enough() ? probability.value : 0.0,
          rate_per_m.is_enough() ? rate_per_m.value : 0.0};
}

RandomLossFit FitRandomLoss(const std::vector<StrongTrial>& trials, bool has_rate) {
  const std::uint64_t num = trials.size();
  RandomLossFit fit{NotEnough(num), NotEnough(has_rate ? num : 0)};
  const auto num_lost = static_cast<std::uint64_t>(std::count_if(
      trials.begin(), trials.end(), [](const StrongTrial& trial) { return !trial.is_returned; }));
  if (num < kMinSamples) return fit;
  if (!has_rate) {
    fit.probability = Proportion(num_lost, num);
    return fit;
  }
  // Of what nothing came back from it is not known whether it could.
  if (num_lost == num) return fit;
  const std::vector<Bin> bins = BinTrials(trials);
  const double share = static_cast<double>(num_lost) / static_cast<double>(num);
  const Estimate offset = Profile(bins, 0, share).Fit(num);
  fit.probability = {ShareOf(offset.value), ShareOf(offset.low), ShareOf(offset.high), num};
  fit.rate_per_m = Profile(bins, 1, 1e-2 * share).Fit(num);
  return fit;
}

}  // namespace railcast
