#include "analysis/extras/rare/proposal.h"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/base/random.h"

namespace railcast {
namespace {

constexpr std::size_t kMostModes = 4;
constexpr double kLeastSd = 0.1;
/// By which fitted distributions are widened, since their tails decide the greatest weights.
constexpr double kWidening = 1.2;
/// What is known of each factor of a mode beforehand, in points by p: so few points do not tell
/// that a factor matters.
constexpr double kPointsOfP = 3.0;
/// Numbers of draws of a point and of a fit that are of no factor.
enum : std::uint32_t { kModeDraw = 0xFFFFFFFF, kCentreDraw = 0xFFFFFFFE };

// Uniform in [0, 1), with 53 bits.
double UnitDraw(std::uint64_t seed, std::uint32_t index, std::uint32_t item) {
  const auto words = RandomWords(seed, RandomUse::kRareDraw, index, item);
  return static_cast<double>(((std::uint64_t{words[0]} << 32U) | words[1]) >> 11U) * 0x1p-53;
}

// The standard normal quantile.
double NormalScore(double unit) {
  constexpr double kLeast = 0x1p-54;
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * std::max(unit, kLeast));
}

std::size_t ValueAt(const RarePoint& point, std::size_t factor) {
  return static_cast<std::size_t>(point[factor]);
}

bool Matters(const RareFactor& factor, const RarePoint& point) {
  return !factor.only_with || ValueAt(point, factor.only_with->factor) == factor.only_with->value;
}

std::size_t ValueOfUnit(const std::vector<double>& probabilities, double unit) {
  std::size_t value = 0;
  while (value + 1 < probabilities.size() && unit >= probabilities[value]) {
    unit -= probabilities[value++];
  }
  return value;
}

// The density of a mode relative to p.
double RatioOf(const ProposalMode& mode,
               const std::vector<RareFactor>& factors,
               const RarePoint& point) {
  double ratio = 1.0;
  for (std::size_t i = 0; i < factors.size(); ++i) {
    if (!Matters(factors[i], point)) continue;
    const std::vector<double>& usual = factors[i].probabilities;
    if (usual.empty()) {
      const double score = (point[i] - mode.numbers[i].mean) / mode.numbers[i].sd;
      ratio *= std::exp(0.5 * (point[i] * point[i] - score * score)) / mode.numbers[i].sd;
    } else {
      ratio *= mode.choices[i][ValueAt(point, i)] / usual[ValueAt(point, i)];
    }
  }
  return ratio;
}

double SquaredDistance(const std::vector<RareFactor>& factors,
                       const RarePoint& one,
                       const RarePoint& other) {
  constexpr double kOfOtherChoice = 2.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < factors.size(); ++i) {
    if (!Matters(factors[i], one) || !Matters(factors[i], other)) continue;
    const double step = one[i] - other[i];
    if (factors[i].probabilities.empty()) {
      sum += step * step;
    } else if (step != 0.0) {
      sum += kOfOtherChoice;
    }
  }
  return sum;
}

/// Fits modes to weighted points.
class ModeFit {
 public:
  ModeFit(const std::vector<RareFactor>& factors, const WeightedPoints& elite)
      : factors_(factors), elite_(elite) {}

  [[nodiscard]] std::vector<ProposalMode> Run(std::uint64_t seed) {
    constexpr int kNumRounds = 8;
    BeginAtCentres(seed);
    std::vector<ProposalMode> modes = FitModes();
    for (int i = 0; i < kNumRounds && modes.size() > 1; ++i) {
      Share(modes);
      modes = FitModes();
    }
    for (ProposalMode& mode : modes) {
      for (NormalScores& law : mode.numbers) {
        law.sd = std::clamp(kWidening * law.sd, kLeastSd, std::max(law.sd, 1.0));
      }
    }
    return modes;
  }

 private:
  // Centres far from each other (k-means++; Arthur and Vassilvitskii 2007), a point to the nearest.
  void BeginAtCentres(std::uint64_t seed) {
    constexpr double kPointsOfMode = 15.0;
    const auto& weights = elite_.weights;
    const auto num = static_cast<std::size_t>(
        std::clamp(EffectiveOf(weights) / kPointsOfMode, 1.0, static_cast<double>(kMostModes)));
    std::vector<double> chances = weights;
    std::vector<double> nearest(weights.size(), std::numeric_limits<double>::infinity());
    of_mode_.assign(num, std::vector<double>(weights.size(), 0.0));
    std::vector<std::size_t> mode_of(weights.size(), 0);
    for (std::size_t mode = 0; mode < num; ++mode) {
      const double all = std::accumulate(chances.begin(), chances.end(), 0.0);
      double left = all * UnitDraw(seed, static_cast<std::uint32_t>(mode), kCentreDraw);
      std::size_t centre = 0;
      while (centre + 1 < chances.size() && left >= chances[centre]) left -= chances[centre++];
      for (std::size_t i = 0; i < weights.size(); ++i) {
        const double distance = SquaredDistance(factors_, elite_.points[i], elite_.points[centre]);
        if (distance < nearest[i]) {
          nearest[i] = distance;
          mode_of[i] = mode;
        }
        chances[i] = weights[i] * nearest[i];
      }
    }
    for (std::size_t i = 0; i < weights.size(); ++i) of_mode_[mode_of[i]][i] = weights[i];
  }

  // Shares each point's weight among the modes.
  void Share(const std::vector<ProposalMode>& modes) {
    of_mode_.assign(modes.size(), std::vector<double>(elite_.points.size(), 0.0));
    for (std::size_t i = 0; i < elite_.points.size(); ++i) {
      double sum = 0.0;
      for (std::size_t mode = 0; mode < modes.size(); ++mode) {
        of_mode_[mode][i] = modes[mode].share * RatioOf(modes[mode], factors_, elite_.points[i]);
        sum += of_mode_[mode][i];
      }
      for (auto& weights : of_mode_) {
        weights[i] = sum > 0.0 ? weights[i] * elite_.weights[i] / sum : 0.0;
      }
    }
  }

  [[nodiscard]] std::vector<ProposalMode> FitModes() const {
    constexpr double kLeastShare = 0.02;
    const double all = std::accumulate(elite_.weights.begin(), elite_.weights.end(), 0.0);
    std::vector<ProposalMode> modes;
    double sum = 0.0;
    for (const std::vector<double>& weights : of_mode_) {
      const double share = std::accumulate(weights.begin(), weights.end(), 0.0) / all;
      if (share < kLeastShare) continue;
      modes.push_back(FitMode(weights));
      modes.back().share = share;
      sum += share;
    }
    for (ProposalMode& mode : modes) mode.share /= sum;
    return modes;
  }

  [[nodiscard]] ProposalMode FitMode(const std::vector<double>& weights) const {
    ProposalMode mode;
    mode.numbers.resize(factors_.size());
    mode.choices.resize(factors_.size());
    for (std::size_t factor = 0; factor < factors_.size(); ++factor) {
      if (factors_[factor].probabilities.empty()) {
        mode.numbers[factor] = FitNumber(factor, weights);
      } else {
        mode.choices[factor] = FitChoice(factor, weights);
      }
    }
    return mode;
  }

  // Weights of a mode by which a factor is fitted, with the sum of their effective number.
  [[nodiscard]] std::vector<double> CountsOf(std::size_t factor,
                                             const std::vector<double>& weights) const {
    std::vector<double> counts = weights;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (!Matters(factors_[factor], elite_.points[i])) counts[i] = 0.0;
    }
    const double sum = std::accumulate(counts.begin(), counts.end(), 0.0);
    const double num = EffectiveOf(counts);
    for (double& count : counts) count *= sum > 0.0 ? num / sum : 0.0;
    return counts;
  }

  [[nodiscard]] NormalScores FitNumber(std::size_t factor,
                                       const std::vector<double>& weights) const {
    // Moments of the standard normal law.
    double sum = kPointsOfP;
    double first = 0.0;
    double second = kPointsOfP;
    const std::vector<double> counts = CountsOf(factor, weights);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const double score = elite_.points[i][factor];
      sum += counts[i];
      first += counts[i] * score;
      second += counts[i] * score * score;
    }
    const double mean = first / sum;
    return {mean, std::sqrt(second / sum - mean * mean)};
  }

  [[nodiscard]] std::vector<double> FitChoice(std::size_t factor,
                                              const std::vector<double>& weights) const {
    std::vector<double> sums = factors_[factor].probabilities;
    for (double& sum : sums) sum *= kPointsOfP;
    const std::vector<double> counts = CountsOf(factor, weights);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (counts[i] > 0.0) sums[ValueAt(elite_.points[i], factor)] += counts[i];
    }
    const double all = std::accumulate(sums.begin(), sums.end(), 0.0);
    for (double& sum : sums) sum /= all;
    return sums;
  }

  const std::vector<RareFactor>& factors_;
  const WeightedPoints& elite_;
  std::vector<std::vector<double>> of_mode_;  ///< Weights of all points by mode.
};

}  // namespace

double EffectiveOf(const std::vector<double>& weights) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  const double squares = std::inner_product(weights.begin(), weights.end(), weights.begin(), 0.0);
  return squares > 0.0 ? sum * sum / squares : 0.0;
}

RarePoint DrawPoint(const Proposal& proposal, std::uint64_t seed, std::uint32_t index) {
  const ProposalMode* mode = nullptr;
  double left = UnitDraw(seed, index, kModeDraw) - kDefensiveShare;
  if (left >= 0.0 && !proposal.modes.empty()) {
    left /= 1.0 - kDefensiveShare;
    mode = &proposal.modes.front();
    while (mode != &proposal.modes.back() && left >= mode->share) left -= (mode++)->share;
  }
  RarePoint point;
  for (std::size_t i = 0; i < proposal.factors.size(); ++i) {
    const std::vector<double>& usual = proposal.factors[i].probabilities;
    const double unit = UnitDraw(seed, index, static_cast<std::uint32_t>(i));
    if (usual.empty()) {
      const NormalScores law = mode != nullptr ? mode->numbers[i] : NormalScores{};
      point.push_back(law.mean + law.sd * NormalScore(unit));
    } else {
      point.push_back(
          static_cast<double>(ValueOfUnit(mode != nullptr ? mode->choices[i] : usual, unit)));
    }
  }
  return point;
}

bool IsDrawnByP(const Proposal& proposal, std::uint64_t seed, std::uint32_t index) {
  return proposal.modes.empty() || UnitDraw(seed, index, kModeDraw) < kDefensiveShare;
}

double WeightOf(const Proposal& proposal, const RarePoint& point) {
  if (proposal.modes.empty()) return 1.0;
  double ratio = 0.0;
  for (const ProposalMode& mode : proposal.modes) {
    ratio += mode.share * RatioOf(mode, proposal.factors, point);
  }
  return 1.0 / (kDefensiveShare + (1.0 - kDefensiveShare) * ratio);
}

Proposal FitProposal(const std::vector<RareFactor>& factors,
                     const WeightedPoints& elite,
                     std::uint64_t seed) {
  Proposal proposal{.factors = factors};
  if (std::accumulate(elite.weights.begin(), elite.weights.end(), 0.0) > 0.0) {
    proposal.modes = ModeFit(factors, elite).Run(seed);
  }
  return proposal;
}

}  // namespace railcast
