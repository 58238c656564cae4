#include "analysis/extras/rare/rare_event.h"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <string_view>

#include "core/base/text.h"

namespace railcast {
namespace {

constexpr double kLeastEffective = 100.0;
constexpr double kMostShare = 0.05;
constexpr double kMostUnknown = 0.1;

bool HasFailed(double score) {
  return score < 0.0;
}

bool HasPairs(const RareEvidence& evidence) {
  return !evidence.pairs[0].weights.empty();
}

// @param most_weight Of points that the proposals draw.
std::vector<double> CheapTerms(const WeightedTrials& trials,
                               const std::vector<double>& weights,
                               double most_weight) {
  std::vector<double> terms;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const bool counts = HasFailed(trials.scores[i].cheap) && weights[i] <= most_weight;
    terms.push_back(counts ? weights[i] : 0.0);
  }
  return terms;
}

std::vector<double> CorrectionTerms(const WeightedTrials& pairs, double most_weight) {
  std::vector<double> terms;
  for (std::size_t i = 0; i < pairs.weights.size(); ++i) {
    const double weight = pairs.weights[i] <= most_weight ? pairs.weights[i] : 0.0;
    const double dear = HasFailed(pairs.scores[i].dear) ? weight : 0.0;
    const double cheap = HasFailed(pairs.scores[i].cheap) ? weight : 0.0;
    terms.push_back(dear - cheap);
  }
  return terms;
}

// The square of the weight that a disagreement between levels would have: that of the trials that
// failed on either, or of all if none did.
double SquareOfDisagreement(const std::array<WeightedTrials, 2>& pairs, double most_weight) {
  double of_failed = 0.0;
  double of_all = 0.0;
  std::uint64_t num_failed = 0;
  std::uint64_t num = 0;
  for (const WeightedTrials& trials : pairs) {
    for (std::size_t i = 0; i < trials.weights.size(); ++i) {
      if (trials.weights[i] > most_weight) continue;
      const double square = trials.weights[i] * trials.weights[i];
      of_all += square;
      ++num;
      if (!HasFailed(trials.scores[i].cheap) && !HasFailed(trials.scores[i].dear)) continue;
      of_failed += square;
      ++num_failed;
    }
  }
  return num_failed > 0 ? of_failed / static_cast<double>(num_failed)
                        : of_all / static_cast<double>(std::max<std::uint64_t>(num, 1));
}

// The mean over trials of several laws, whose numbers are given.
RareLevel LevelOf(std::span<const std::vector<double>> terms_by_law) {
  RareLevel level;
  for (const std::vector<double>& terms : terms_by_law) level.num += terms.size();
  const auto all = static_cast<double>(level.num);
  for (const std::vector<double>& terms : terms_by_law) {
    if (terms.empty()) continue;
    const double sum = std::accumulate(terms.begin(), terms.end(), 0.0);
    const double squares = std::inner_product(terms.begin(), terms.end(), terms.begin(), 0.0);
    level.mean += sum / all;
    level.variance += std::max(squares - sum * sum / static_cast<double>(terms.size()), 0.0) / all;
  }
  return level;
}

// @param terms Whose sum is the mean, but for signs.
Estimate IntervalOf(double mean,
                    double squared_error,
                    const std::vector<double>& terms,
                    std::uint64_t num) {
  if (mean <= 0.0) return NotEnough(num);
  const auto quantile = [](double sum, double variance, double share) {
    constexpr double kMostDegrees = 1e9;  // Where all terms are equal, or too small to be squared.
    const double degrees =
        variance > 0.0 ? std::min(2.0 * sum * sum / variance, kMostDegrees) : kMostDegrees;
    return std::min(sum / degrees * ChiSquared(degrees, share), 1.0);
  };
  const double largest = *std::ranges::max_element(terms);
  // Where two levels nearly cancel, the law of so small a sum has no upper end to speak of.
  const double normal = std::min(mean + NormalQuantile() * std::sqrt(squared_error), 1.0);
  const double high = quantile(mean + largest, squared_error + largest * largest, 1.0 - kTail);
  return {std::min(mean, 1.0), quantile(mean, squared_error, kTail), std::max(high, normal), num};
}

// Clopper and Pearson's interval of a share.
Estimate ExactShare(std::uint64_t num_of, std::uint64_t num) {
  const auto k = static_cast<double>(num_of);
  const auto n = static_cast<double>(num);
  return {k / n, num_of == 0 ? 0.0 : boost::math::ibeta_inv(k, n - k + 1.0, kTail),
          num_of == num ? 1.0 : boost::math::ibeta_inv(k + 1.0, n - k, 1.0 - kTail), num};
}

// The sum of independent quantities of which the second one may be subtracted.
Estimate Joined(const Estimate& one, const Estimate& other, double sign, std::uint64_t num) {
  const double value = one.value + sign * other.value;
  const double below = sign > 0.0 ? other.value - other.low : other.high - other.value;
  const double above = sign > 0.0 ? other.high - other.value : other.value - other.low;
  return {value, value - std::hypot(one.value - one.low, below),
          value + std::hypot(one.high - one.value, above), num};
}

// The greatest weight of points that all laws of a level together draw at least twice as often as p
// does on the dearest one.
double MostWeight(const RareEvidence& evidence, std::span<const WeightedTrials> by_law) {
  constexpr double kOften = 2.0;
  if (evidence.own.scores.empty()) return std::numeric_limits<double>::infinity();
  double num = 0.0;
  for (const WeightedTrials& trials : by_law) num += static_cast<double>(trials.weights.size());
  return num / (kOften * static_cast<double>(evidence.own.scores.size()));
}

RareBeyond BeyondOf(const RareEvidence& evidence) {
  const OwnTrials& own = evidence.own;
  RareBeyond beyond{.num = own.scores.size()};
  if (beyond.num == 0) return beyond;
  const double most_cheap = MostWeight(evidence, evidence.cheap);
  const double most_pair = MostWeight(evidence, evidence.pairs);
  for (std::size_t i = 0; i < own.scores.size(); ++i) {
    const int cheap = HasFailed(own.scores[i].cheap) ? 1 : 0;
    int more = own.cheap_weights[i] > most_cheap ? cheap : 0;
    if (!own.pair_weights.empty() && own.pair_weights[i] > most_pair) {
      more += (HasFailed(own.scores[i].dear) ? 1 : 0) - cheap;
    }
    beyond.num_more += more > 0 ? 1 : 0;
    beyond.num_fewer += more < 0 ? 1 : 0;
  }
  beyond.share = ExactShare(beyond.num_more, beyond.num);
  // Failures on the cheap level are what the proposals go for: none that was not met is taken off.
  if (beyond.num_fewer > 0) {
    beyond.share = Joined(beyond.share, ExactShare(beyond.num_fewer, beyond.num), -1.0, beyond.num);
  }
  return beyond;
}

/// Means over all points that the proposals draw.
struct MetPart {
  RareLevel cheap{};
  RareLevel correction{};
  std::vector<double> terms{};  ///< Whose sum is the mean.

  [[nodiscard]] double mean() const { return cheap.mean + correction.mean; }
  [[nodiscard]] double squared_error() const {
    const auto of = [](const RareLevel& level) {
      return level.num > 0 ? level.variance / static_cast<double>(level.num) : 0.0;
    };
    return of(cheap) + of(correction);
  }
};

MetPart MetPartOf(const RareEvidence& evidence) {
  MetPart met;
  const auto keep = [&](std::span<const std::vector<double>> by_law, const RareLevel& level) {
    for (const std::vector<double>& terms : by_law) {
      for (const double term : terms) met.terms.push_back(term / static_cast<double>(level.num));
    }
  };
  std::array<std::vector<double>, 3> cheap;
  for (std::size_t i = 0; i < cheap.size(); ++i) {
    const WeightedTrials& trials = evidence.cheap[i];
    cheap[i] = CheapTerms(trials, trials.weights, MostWeight(evidence, evidence.cheap));
  }
  met.cheap = LevelOf(cheap);
  keep(cheap, met.cheap);
  if (HasPairs(evidence)) {
    constexpr double kMoreDisagreements = 2.0;
    const double most = MostWeight(evidence, evidence.pairs);
    const std::array<std::vector<double>, 2> pairs = {CorrectionTerms(evidence.pairs[0], most),
                                                      CorrectionTerms(evidence.pairs[1], most)};
    met.correction = LevelOf(pairs);
    met.correction.variance += kMoreDisagreements * SquareOfDisagreement(evidence.pairs, most) /
                               static_cast<double>(met.correction.num);
    keep(pairs, met.correction);
  }
  return met;
}

// The levels may cancel, or proposals meet nothing, where trials by p meet most of what fails.
Estimate IntervalOfMet(const MetPart& met, std::uint64_t num) {
  const double mean = met.mean();
  if (mean > 0.0) return IntervalOf(mean, met.squared_error(), met.terms, num);
  const double reach = NormalQuantile() * std::sqrt(met.squared_error());
  return {mean, mean - reach, mean + reach, num};
}

// By the trials of one proposal alone, with their own weights.
Estimate ByProposal(const WeightedTrials& trials) {
  std::vector<double> terms =
      CheapTerms(trials, trials.own_weights, std::numeric_limits<double>::infinity());
  const RareLevel level = LevelOf({&terms, 1});
  const auto num = static_cast<double>(level.num);
  for (double& term : terms) term /= num;
  return IntervalOf(level.mean, level.variance / num, terms, level.num);
}

// The share of trials on a level that are not known.
double UnknownShare(std::span<const WeightedTrials> by_law, double RareScores::*level) {
  double sum = 0.0;
  std::size_t num = 0;
  for (const WeightedTrials& trials : by_law) {
    for (std::size_t i = 0; i < trials.weights.size(); ++i) {
      if (std::isnan(trials.scores[i].*level)) sum += trials.weights[i];
    }
    num += trials.weights.size();
  }
  return sum / static_cast<double>(std::max<std::size_t>(num, 1));
}

// On either level.
std::uint64_t NumFailed(const RareEvidence& evidence) {
  std::uint64_t num = 0;
  const auto count = [&](std::span<const WeightedTrials> by_law) {
    for (const WeightedTrials& trials : by_law) {
      num += static_cast<std::uint64_t>(
          std::ranges::count_if(trials.scores, [](const RareScores& scores) {
            return HasFailed(scores.cheap) || HasFailed(scores.dear);
          }));
    }
  };
  count(evidence.cheap);
  count(evidence.pairs);
  return num;
}

// Whether all trials were drawn by p.
bool IsPlain(const RareEvidence& evidence) {
  return !HasPairs(evidence) &&
         std::ranges::all_of(evidence.cheap, [](const WeightedTrials& trials) {
           return std::ranges::count(trials.weights, 1.0) == std::ssize(trials.weights);
         });
}

// "P is 0.0012 to 0.0015 by one".
std::string RangeText(const Estimate& estimate) {
  if (!estimate.is_enough()) return "0";
  return NumberText(estimate.low) + " to " + NumberText(estimate.high);
}

// What speaks against the proposals.
std::string FaultOfSearch(const RareFigure& figure) {
  const Estimate& one = figure.by_proposal[0];
  const Estimate& other = figure.by_proposal[1];
  if (one.is_enough() != other.is_enough() || one.low > other.high || other.low > one.high) {
    return "two independent searches disagree (" + RangeText(one) + " and " + RangeText(other) +
           "): a kind of failure may be missing";
  }
  if (figure.effective < kLeastEffective) {
    return "only " + NumberText(std::round(figure.effective)) + " trials are effective, and " +
           NumberText(kLeastEffective) + " are needed";
  }
  if (figure.largest_share > kMostShare) {
    return "one trial is " + NumberText(std::round(100.0 * figure.largest_share)) +
           " % of the sum: the search has missed where it comes from";
  }
  return "";
}

// The share of trials on the level that decides that are not known.
double UnknownShare(const RareEvidence& evidence) {
  return HasPairs(evidence) ? UnknownShare(evidence.pairs, &RareScores::dear)
                            : UnknownShare(evidence.cheap, &RareScores::cheap);
}

std::string UnknownText(double unknown) {
  return "too many trials say neither yes nor no: a share of " + NumberText(unknown) + " of all";
}

std::string RefusalOf(const RareFigure& figure, double mean, double unknown) {
  std::string fault = figure.rests_on_search ? FaultOfSearch(figure) : "";
  if (!fault.empty()) return fault;
  if (mean <= 0.0) return "the levels disagree by more than the probability";
  return unknown <= kMostUnknown * mean ? "" : UnknownText(unknown);
}

}  // namespace

RareFigure EstimateRareFigure(const RareEvidence& evidence) {
  RareFigure figure;
  MetPart met = MetPartOf(evidence);
  figure.cheap = met.cheap;
  figure.correction = met.correction;
  figure.beyond = BeyondOf(evidence);
  figure.is_plain = IsPlain(evidence);
  figure.rests_on_search = !figure.is_plain && figure.beyond.mean() <= met.mean();
  for (std::size_t i = 0; i < 2; ++i) figure.by_proposal[i] = ByProposal(evidence.cheap[i]);
  const std::uint64_t num_dearest = HasPairs(evidence) ? met.correction.num : met.cheap.num;
  const std::uint64_t num_failed = NumFailed(evidence);
  const double unknown = UnknownShare(evidence);
  if (num_failed == 0 && unknown > 0.0) {
    figure.refusal = UnknownText(unknown);
    return figure;
  }
  if (num_failed == 0) {
    figure.at_most = ExactShare(0, figure.beyond.num > 0 ? figure.beyond.num : num_dearest).high;
    figure.refusal = figure.is_plain ? "nothing failed as drawn" : "nothing failed";
    return figure;
  }
  for (double& term : met.terms) term = std::abs(term);
  const double sum = std::accumulate(met.terms.begin(), met.terms.end(), 0.0);
  if (sum > 0.0) figure.largest_share = *std::ranges::max_element(met.terms) / sum;
  figure.effective = EffectiveOf(met.terms);
  const std::uint64_t num = met.cheap.num + met.correction.num;
  figure.refusal = RefusalOf(figure, met.mean() + figure.beyond.mean(), unknown);
  figure.probability = figure.met = NotEnough(num);
  if (!figure.is_known()) return figure;
  figure.met = figure.is_plain ? Proportion(num_failed, num) : IntervalOfMet(met, num);
  figure.probability = figure.met;
  if (figure.beyond.num > 0) {
    figure.probability = Joined(figure.met, figure.beyond.share, 1.0, num);
    figure.probability.low = std::max(figure.probability.low, 0.0);
    figure.probability.high = std::min(figure.probability.high, 1.0);
  }
  return figure;
}

double PlainTrialsFor(const Estimate& probability) {
  const double error = 0.5 * (probability.high - probability.low) / NormalQuantile();
  return probability.value * (1.0 - probability.value) / (error * error);
}

}  // namespace railcast
