#include "core/certify/weighted_shares.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "core/base/error.h"

namespace railcast {
namespace {

constexpr double kNormalQuantile = 1.959963984540054;  // For 97.5 %.

// The regularised incomplete beta function I_x(a, b), by its continued fraction (DLMF 8.17.22) in
// Lentz's way.
double IncompleteBeta(double a, double b, double x) {
  constexpr int kMostTerms = 1000;
  constexpr double kEnough = 1e-12;
  if (x <= 0.0 || x >= 1.0) return x <= 0.0 ? 0.0 : 1.0;
  // There it converges in some square roots of a and b.
  if (x > (a + 1.0) / (a + b + 2.0)) return 1.0 - IncompleteBeta(b, a, 1.0 - x);
  double c = 1.0;
  double d = 1.0 / (1.0 - (a + b) * x / (a + 1.0));
  double sum = d;
  for (int m = 1; m < kMostTerms; ++m) {
    const double even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
    for (const double term : {even, odd}) {
      d = 1.0 / (1.0 + term * d);
      c = 1.0 + term / c;
      sum *= c * d;
    }
    if (std::abs(c * d - 1.0) < kEnough) break;
  }
  return sum / a *
         std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) +
                  b * std::log1p(-x));
}

// The value below which a quantity with the beta distribution is with a probability.
double BetaQuantile(double a, double b, double probability) {
  constexpr int kNumHalvings = 50;
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < kNumHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (IncompleteBeta(a, b, middle) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Clopper and Pearson's interval of a share of so many independent items, which need not be a whole
// number (Korn and Graubard 1998, Survey Methodology 24). Wilson's is too short where few of few
// items are wrong.
CertifiedFigure ExactInterval(double share, double num) {
  constexpr double kTail = 0.025;
  const double of = share * num;
  const double others = num - of;
  return {share, of > 0.0 ? std::min(BetaQuantile(of, others + 1.0, kTail), share) : 0.0,
          others > 0.0 ? std::max(BetaQuantile(of + 1.0, others, 1.0 - kTail), share) : 1.0};
}

// The stratum that stands for those of one label and state, or of one state.
Stratum WithoutRange(Stratum stratum) {
  stratum.range_bin = 0;
  return stratum;
}
Stratum WithoutLabel(Stratum stratum) {
  return {0, 0, stratum.is_edge, stratum.has_return};
}
Stratum OfAll(Stratum /*stratum*/) {
  return {};
}

}  // namespace

void WeightedShares::AddFirings(const Stratum& stratum, std::uint64_t num, double probability) {
  Population& population = strata_[stratum];
  population.num += num;
  population.probability = probability;
  num_firings_ += num;
}

double WeightedShares::share_without_drawn() const {
  const std::set<Stratum> drawn(drawn_.begin(), drawn_.end());
  std::uint64_t without = 0;
  for (const auto& [stratum, population] : strata_) {
    if (!drawn.contains(stratum)) without += population.num;
  }
  return static_cast<double>(without) / static_cast<double>(num_firings_);
}

std::vector<WeightedShares::Group> WeightedShares::Groups() const {
  std::map<Stratum, Group> open;
  for (const auto& [stratum, population] : strata_) open[stratum].num_firings = population.num;
  for (std::size_t i = 0; i < drawn_.size(); ++i) open.at(drawn_[i]).drawn.push_back(i);
  std::vector<Group> groups;
  for (const auto coarser : {WithoutRange, WithoutLabel, OfAll}) {
    std::map<Stratum, Group> joined;
    for (auto& [stratum, group] : open) {
      if (group.drawn.size() >= kLeastDrawn) {
        groups.push_back(std::move(group));
        continue;
      }
      Group& wider = joined[coarser(stratum)];
      wider.num_firings += group.num_firings;
      wider.drawn.insert(wider.drawn.end(), group.drawn.begin(), group.drawn.end());
    }
    open = std::move(joined);
  }
  // What is left over is a group of its own, if one can tell anything of it, or joins the largest.
  for (auto& [stratum, group] : open) {
    if (group.drawn.size() >= 2 || groups.empty()) {
      groups.push_back(std::move(group));
    } else {
      Group& largest = *std::ranges::max_element(groups, {}, &Group::num_firings);
      largest.num_firings += group.num_firings;
      largest.drawn.insert(largest.drawn.end(), group.drawn.begin(), group.drawn.end());
    }
  }
  return groups;
}

std::vector<double> WeightedShares::Weights(const std::vector<Group>& groups) const {
  std::vector<double> weights(drawn_.size());
  for (const Group& group : groups) {
    double sum = 0.0;
    for (const std::size_t i : group.drawn) sum += WeightOf(i);
    for (const std::size_t i : group.drawn) {
      weights[i] = WeightOf(i) / sum * static_cast<double>(group.num_firings);
    }
  }
  return weights;
}

double WeightedShares::VarianceOf(const std::vector<double>& values,
                                  const std::vector<Group>& groups) const {
  const std::vector<double> weights = Weights(groups);
  double variance = 0.0;
  for (const Group& group : groups) {
    const auto num = static_cast<double>(group.drawn.size());
    if (num < 2.0) continue;
    double sum = 0.0;
    double sum_of_weights = 0.0;
    for (const std::size_t i : group.drawn) {
      sum += weights[i] * values[i];
      sum_of_weights += weights[i];
    }
    const double mean = sum / sum_of_weights;
    double squares = 0.0;
    for (const std::size_t i : group.drawn) {
      const double residual = weights[i] * (values[i] - mean);
      squares += residual * residual * (1.0 - probabilities_[i]);
    }
    variance += squares * num / (num - 1.0);
  }
  return variance;
}

double WeightedShares::EffectiveNumber(double share,
                                       const std::vector<double>& of,
                                       const std::vector<double>& among) const {
  const std::vector<Group> groups = Groups();
  const std::vector<double> weights = Weights(groups);
  // If all items are alike, the scatter of the weights is what makes them count for fewer. Strata
  // are not trusted to narrow the interval beyond that: where few items are wrong, those in which
  // none was drawn seem to have no scatter at all.
  double total = 0.0;
  double squares = 0.0;
  std::vector<double> residuals(of.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    total += weights[i] * among[i];
    squares += weights[i] * weights[i] * among[i] * among[i];
    residuals[i] = of[i] - share * among[i];
  }
  const double alike = total * total / squares;
  const double variance = VarianceOf(residuals, groups) / (total * total);
  return variance > 0.0 ? std::min(share * (1.0 - share) / variance, alike) : alike;
}

std::optional<CertifiedFigure> WeightedShares::Share(const std::vector<double>& of,
                                                     const std::vector<double>& among) const {
  Check(of.size() == drawn_.size() && among.size() == drawn_.size(), "there is one for each");
  const std::vector<double> weights = Weights(Groups());
  const double total = std::inner_product(weights.begin(), weights.end(), among.begin(), 0.0);
  if (!(total > 0.0)) return std::nullopt;
  const double share = std::inner_product(weights.begin(), weights.end(), of.begin(), 0.0) / total;
  return ExactInterval(share, EffectiveNumber(share, of, among));
}

std::optional<CertifiedFigure> WeightedShares::Quantile(
    std::vector<std::pair<std::size_t, double>> values, double share) const {
  if (values.empty()) return std::nullopt;
  std::ranges::sort(values, {}, &std::pair<std::size_t, double>::second);
  const std::vector<double> weights = Weights(Groups());
  double total = 0.0;
  for (const auto& [firing, value] : values) total += weights[firing];
  // The smallest value up to which at least so much of the total lies.
  const auto at = [&](double part) {
    double sum = 0.0;
    for (const auto& [firing, value] : values) {
      sum += weights[firing];
      if (sum >= part * total) return value;
    }
    return values.back().second;
  };
  const double quantile = at(share);
  std::vector<double> below(drawn_.size());
  std::vector<double> all(drawn_.size());
  for (const auto& [firing, value] : values) {
    all[firing] += 1.0;
    if (value <= quantile) below[firing] += 1.0;
  }
  const double half =
      kNormalQuantile * std::sqrt(share * (1.0 - share) / EffectiveNumber(share, below, all));
  CertifiedFigure figure{quantile, at(share - half), {}};
  // Beyond the largest value nothing was drawn, but there may be something.
  if (share + half < 1.0) figure.high = at(share + half);
  return figure;
}

}  // namespace railcast
