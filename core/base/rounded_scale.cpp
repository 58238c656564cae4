#include "core/base/rounded_scale.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/base/median.h"

namespace railcast {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

double Below(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

double DensityAt(double x) {
  return std::exp(-0.5 * x * x) / std::sqrt(kTurn);
}

/// E max(0, x - d) of a normal d.
double MeanAbove(double x, double sigma) {
  const double z = x / sigma;
  return x * Below(z) + sigma * DensityAt(z);
}

/// Half of E max(0, x - d)^2.
double HalfSquareAbove(double x, double sigma) {
  const double z = x / sigma;
  return 0.5 * ((x * x + sigma * sigma) * Below(z) + x * sigma * DensityAt(z));
}

/// The probability that a sample is counted at so many steps from its mean.
/// @param sigma In steps.
/// @param on_steps The share of the first law of the header.
double ChanceOf(double steps, double sigma, double on_steps) {
  const double on = MeanAbove(1.0 - steps, sigma) - 2.0 * MeanAbove(-steps, sigma) +
                    MeanAbove(-1.0 - steps, sigma);
  const double off =
      HalfSquareAbove(1.5 - steps, sigma) - 3.0 * HalfSquareAbove(0.5 - steps, sigma) +
      3.0 * HalfSquareAbove(-0.5 - steps, sigma) - HalfSquareAbove(-1.5 - steps, sigma);
  return std::max(1e-300, on_steps * on + (1.0 - on_steps) * off);
}

/// How likely samples are, given that they are within so many steps of their mean.
class RoundedLikelihood {
 public:
  RoundedLikelihood(const std::vector<RoundedSamples>& samples, RoundedValues rounded) {
    for (const RoundedSamples& each : samples) {
      const double share = std::clamp(each.num_on_steps / std::max(1.0, each.num), 0.0, 1.0);
      parts_.push_back(
          {.samples = &each, .on_steps = rounded == RoundedValues::kOne ? 1.0 : share});
      Part& part = parts_.back();
      part.mean = Quantile(each, 0.5);
      // Nine tenths of the samples, to begin with.
      part.reach = std::max(1.0, std::ceil(0.5 * (Quantile(each, 0.95) - Quantile(each, 0.05))));
    }
  }

  /// Takes samples up to three standard deviations into account, as many of them as outliers as
  /// there are beyond, up to three times as far.
  void LimitTo(double sigma) {
    for (Part& part : parts_) {
      const auto [num, sum] = Within(part, part.reach);
      const double mean = sum / std::max(1.0, num);
      // Four standard errors are no chance.
      const bool is_between = std::abs(mean - std::round(mean)) > 4.0 * part.reach / std::sqrt(num);
      part.mean = is_between ? mean : std::round(mean);
      // Rounding twice adds a sixth of a squared step.
      const double in_steps = std::hypot(sigma / part.samples->step, 0.41);
      part.reach = std::max(1.0, std::ceil(3.0 * in_steps - 0.5));
      const double within = Within(part, part.reach).first;
      const double beyond = Within(part, 3.0 * part.reach).first - within;
      part.outliers = beyond / (4.0 * part.reach * std::max(1.0, within));
    }
  }

  /// The logarithm.
  [[nodiscard]] double At(double sigma) const {
    double sum = 0.0;
    for (const Part& part : parts_) {
      double all = 0.0;
      double num = 0.0;
      const double middle = std::round(part.mean);
      for (double steps = middle - part.reach; steps <= middle + part.reach; ++steps) {
        const double chance =
            ChanceOf(steps - part.mean, sigma / part.samples->step, part.on_steps) + part.outliers;
        all += chance;
        const auto found = part.samples->by_steps.find(static_cast<std::int64_t>(steps));
        if (found == part.samples->by_steps.end()) continue;
        num += found->second;
        sum += found->second * std::log(chance);
      }
      sum -= num * std::log(all);
    }
    return sum;
  }

 private:
  struct Part {
    const RoundedSamples* samples{};
    double on_steps{};
    double mean{};      ///< In steps, as all below.
    double reach{};     ///< From the mean.
    double outliers{};  ///< By step, as a share of the samples.
  };

  /// The number of the samples within so many steps of their mean, and their sum in steps.
  static std::pair<double, double> Within(const Part& part, double reach) {
    std::pair<double, double> sums;
    for (const auto& [steps, count] : part.samples->by_steps) {
      if (std::abs(static_cast<double>(steps) - std::round(part.mean)) > reach) continue;
      sums.first += count;
      sums.second += count * static_cast<double>(steps);
    }
    return sums;
  }

  static double Quantile(const RoundedSamples& samples, double share) {
    double num = 0.0;
    for (const auto& [steps, count] : samples.by_steps) {
      num += count;
      if (num >= share * samples.num) return static_cast<double>(steps);
    }
    return 0.0;
  }

  std::vector<Part> parts_;
};

/// Where a function that rises or falls throughout crosses 0 between two places, of logarithms.
double Crossing(const std::function<double(double)>& function, double from, double to) {
  constexpr int kRounds = 50;
  const bool is_above = function(from) > 0.0;
  for (int round = 0; round < kRounds; ++round) {
    const double middle = std::sqrt(from * to);
    ((function(middle) > 0.0) == is_above ? from : to) = middle;
  }
  return std::sqrt(from * to);
}

/// The mean cosine of samples at one multiple of a frequency after the other, by the recurrence of
/// Chebyshev's polynomials, which takes a tenth of the time of as many cosines.
class CosineSums {
 public:
  CosineSums(const std::vector<double>& samples, double frequency)
      : width_(frequency), before_(samples.size(), 1.0) {
    for (const double sample : samples) {
      now_.push_back(std::cos(kTurn * frequency * sample));
      twice_first_.push_back(2.0 * now_.back());
    }
  }

  void Next() {
    ++times_;
    for (std::size_t i = 0; i < now_.size(); ++i) {
      before_[i] = twice_first_[i] * now_[i] - before_[i];
    }
    std::swap(now_, before_);
  }

  [[nodiscard]] double frequency() const { return times_ * width_; }
  [[nodiscard]] double Mean() const {
    return std::reduce(now_.begin(), now_.end()) / static_cast<double>(now_.size());
  }

 private:
  double width_;
  double times_ = 1.0;
  std::vector<double> now_, before_, twice_first_;
};

/// The highest place of a function: the best of some, of logarithms, and golden section about it.
double Highest(const std::function<double(double)>& function, double from, double to) {
  constexpr int kPlaces = 40;
  constexpr int kRounds = 30;
  constexpr double kGolden = 0.6180339887498949;
  const double width = std::log(to / from) / kPlaces;
  double best = std::log(from);
  for (int place = 0; place <= kPlaces; ++place) {
    const double tried = std::log(from) + place * width;
    if (function(std::exp(tried)) > function(std::exp(best))) best = tried;
  }
  double low = best - width;
  double high = best + width;
  for (int round = 0; round < kRounds; ++round) {
    const double a = high - kGolden * (high - low);
    const double b = low + kGolden * (high - low);
    const bool is_beyond = function(std::exp(a)) < function(std::exp(b));
    (is_beyond ? low : high) = is_beyond ? a : b;
  }
  return std::exp(0.5 * (low + high));
}

/// The standard deviation at which as many samples as were seen leave their step where all means
/// are in the middle between two steps.
double MostHidden(const RoundedSamples& samples, RoundedValues rounded) {
  constexpr double kQuantile = 1.96;
  double most = 0.0;
  for (const auto& [steps, count] : samples.by_steps) most = std::max(most, count);
  // Wilson's score interval.
  const double share = 1.0 - most / samples.num;
  const double z2 = kQuantile * kQuantile / samples.num;
  const double seen =
      (share + 0.5 * z2 + std::sqrt(z2 * (share * (1.0 - share) + 0.25 * z2))) / (1.0 + z2);
  const auto excess = [&](double sigma) {
    const double leaves = 2.0 * Below(-0.5 / sigma);  // Sigma in steps.
    const double moves = rounded == RoundedValues::kOne
                             ? leaves
                             : 1.0 - (1.0 - leaves) * (1.0 - leaves) - 0.5 * leaves * leaves;
    return moves - seen;
  };
  const double one = samples.step * Crossing(excess, 0.01, 1.0);
  return rounded == RoundedValues::kOne ? one : std::numbers::sqrt2 * one;
}

}  // namespace

void RoundedSamples::Add(double sample, double weight) {
  num_on_steps += weight * std::cos(kTurn * sample / step);
  num += weight;
  by_steps[std::llround(sample / step)] += weight;
}

void RoundedSamples::Add(const RoundedSamples& others, double weight) {
  num_on_steps += weight * others.num_on_steps;
  num += weight * others.num;
  for (const auto& [steps, count] : others.by_steps) by_steps[steps] += weight * count;
}

RoundedScale FindRoundedScale(const std::vector<RoundedSamples>& samples, RoundedValues rounded) {
  // Half of the 95 % quantile of chi-squared, 1.92, times the square of 1.16: which samples count
  // is found by themselves, which spreads the value by so much more (of 2,000 simulated ones).
  constexpr double kDrop = 2.6;
  constexpr double kHidden = 0.55;
  const RoundedSamples& most = *std::ranges::max_element(samples, {}, &RoundedSamples::num);
  double least = most.step;
  double highest = most.step;
  for (const RoundedSamples& each : samples) {
    least = std::min(least, 1e-3 * each.step);
    if (each.by_steps.empty()) continue;
    const auto width =
        static_cast<double>(each.by_steps.rbegin()->first - each.by_steps.begin()->first);
    highest = std::max(highest, (width + 1.0) * each.step);
  }
  RoundedLikelihood likelihood(samples, rounded);
  const auto at = [&](double sigma) { return likelihood.At(sigma); };
  RoundedScale scale;
  constexpr int kRounds = 8;
  for (int round = 0; round < kRounds; ++round) {
    const double before = scale.value;
    scale.value = Highest(at, least, highest);
    if (round + 1 == kRounds || std::abs(scale.value - before) < 1e-4 * scale.value) break;
    likelihood.LimitTo(scale.value);
  }
  const double least_likely = at(scale.value) - kDrop;
  const auto margin = [&](double sigma) { return at(sigma) - least_likely; };
  scale.low = margin(least) > 0.0 ? 0.0 : Crossing(margin, least, scale.value);
  scale.high = margin(highest) > 0.0 ? highest : Crossing(margin, scale.value, highest);
  const double of_one = rounded == RoundedValues::kBoth ? std::numbers::sqrt2 : 1.0;
  if (scale.value < kHidden * of_one * most.step) {
    scale.high = std::max(scale.high, MostHidden(most, rounded));
  }
  if (scale.value <= 2.0 * least) scale.value = 0.0;
  return scale;
}

double FindStep(const std::vector<double>& samples) {
  constexpr std::size_t kMost = 1000;
  constexpr double kFinest = 50.0;  // Parts of the median magnitude.
  constexpr double kPerLobe = 10.0;
  constexpr double kLeastShare = 0.25;
  std::vector<double> near;
  const std::size_t stride = 1 + samples.size() / kMost;
  for (std::size_t i = 0; i < samples.size(); i += stride) near.push_back(std::abs(samples[i]));
  std::vector<double> others = near;
  std::erase(others, 0.0);
  if (others.empty()) return 0.0;
  const double middle = MedianOf(others);
  std::erase_if(near, [&](double magnitude) { return magnitude > 1.001 * middle; });
  const auto share = [&](double frequency) {
    double sum = 0.0;
    for (const double magnitude : near) sum += std::cos(kTurn * frequency * magnitude);
    return sum / static_cast<double>(near.size());
  };
  const double width = 1.0 / (kPerLobe * middle);
  double before = 1.0;
  bool has_risen = false;
  double best = 0.0;
  double best_frequency = 0.0;
  for (CosineSums sums(near, width); sums.frequency() < kFinest / middle; sums.Next()) {
    const double now = sums.Mean();
    has_risen = has_risen || now > before;
    before = now;
    // A multiple of the frequency has the same peak.
    if (!has_risen || now < 1.15 * best) continue;
    best = now;
    best_frequency = sums.frequency();
  }
  if (best == 0.0) return 0.0;
  const double frequency = Highest(share, best_frequency - width, best_frequency + width);
  const double chance = 4.0 / std::sqrt(static_cast<double>(near.size()));
  return share(frequency) < std::max(kLeastShare, chance) ? 0.0 : 1.0 / frequency;
}

}  // namespace railcast
