#include "analysis/extras/rare/rare_event.h"

#include <algorithm>
#include <cmath>
#include <numeric>
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

std::vector<double> CheapTerms(const WeightedTrials& trials, const std::vector<double>& weights) {
  std::vector<double> terms;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    terms.push_back(HasFailed(trials.scores[i].cheap) ? weights[i] : 0.0);
  }
  return terms;
}

std::vector<double> CorrectionTerms(const WeightedTrials& pairs) {
  std::vector<double> terms;
  for (std::size_t i = 0; i < pairs.weights.size(); ++i) {
    const double dear = HasFailed(pairs.scores[i].dear) ? pairs.weights[i] : 0.0;
    const double cheap = HasFailed(pairs.scores[i].cheap) ? pairs.weights[i] : 0.0;
    terms.push_back(dear - cheap);
  }
  return terms;
}

// The square of the weight that a disagreement between levels would have: that of the trials that
// failed on either, or of all if none did.
double SquareOfDisagreement(const WeightedTrials& pairs) {
  double of_failed = 0.0;
  double of_all = 0.0;
  std::uint64_t num_failed = 0;
  for (std::size_t i = 0; i < pairs.weights.size(); ++i) {
    const double square = pairs.weights[i] * pairs.weights[i];
    of_all += square;
    if (!HasFailed(pairs.scores[i].cheap) && !HasFailed(pairs.scores[i].dear)) continue;
    of_failed += square;
    ++num_failed;
  }
  return num_failed > 0 ? of_failed / static_cast<double>(num_failed)
                        : of_all / static_cast<double>(pairs.weights.size());
}

// @param more_squares Added to the sum of squares.
RareLevel LevelOf(const std::vector<double>& terms, double more_squares = 0.0) {
  RareLevel level{.num = terms.size()};
  if (terms.empty()) return level;
  const auto num = static_cast<double>(terms.size());
  double squares = more_squares;
  for (const double term : terms) {
    level.mean += term / num;
    squares += term * term;
  }
  level.variance = std::max(squares / num - level.mean * level.mean, 0.0);
  return level;
}

// @param terms Whose sum is the mean, but for signs.
Estimate IntervalOf(double mean,
                    double squared_error,
                    const std::vector<double>& terms,
                    std::uint64_t num) {
  if (mean <= 0.0) return NotEnough(num);
  const auto quantile = [](double sum, double variance, double share) {
    constexpr double kMostDegrees = 1e9;  // Where all terms are equal.
    const double degrees = std::min(2.0 * sum * sum / variance, kMostDegrees);
    return std::min(sum / degrees * ChiSquared(degrees, share), 1.0);
  };
  const double largest = *std::ranges::max_element(terms);
  // Where two levels nearly cancel, the law of so small a sum has no upper end to speak of.
  const double normal = std::min(mean + NormalQuantile() * std::sqrt(squared_error), 1.0);
  const double high = quantile(mean + largest, squared_error + largest * largest, 1.0 - kTail);
  return {std::min(mean, 1.0), quantile(mean, squared_error, kTail), std::max(high, normal), num};
}

double UnknownShare(const WeightedTrials& trials, double RareScores::*level) {
  double sum = 0.0;
  for (std::size_t i = 0; i < trials.weights.size(); ++i) {
    if (std::isnan(trials.scores[i].*level)) sum += trials.weights[i];
  }
  return sum / static_cast<double>(std::max<std::size_t>(trials.weights.size(), 1));
}

// On either level.
std::uint64_t NumFailed(const RareEvidence& evidence) {
  std::uint64_t num = 0;
  for (const auto* trials : {&evidence.cheap[0], &evidence.cheap[1], &evidence.pairs}) {
    num += static_cast<std::uint64_t>(
        std::ranges::count_if(trials->scores, [](const RareScores& scores) {
          return HasFailed(scores.cheap) || HasFailed(scores.dear);
        }));
  }
  return num;
}

// Whether all trials were drawn by p.
bool IsPlain(const RareEvidence& evidence) {
  return evidence.pairs.weights.empty() &&
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

// Of the trials on the level that decides, which are not known.
double UnknownShare(const RareEvidence& evidence) {
  if (!evidence.pairs.weights.empty()) return UnknownShare(evidence.pairs, &RareScores::dear);
  return 0.5 * (UnknownShare(evidence.cheap[0], &RareScores::cheap) +
                UnknownShare(evidence.cheap[1], &RareScores::cheap));
}

std::string UnknownText(double unknown) {
  return "too many trials say neither yes nor no: a share of " + NumberText(unknown) + " of all";
}

std::string RefusalOf(const RareFigure& figure, double mean, double unknown) {
  std::string fault = figure.is_plain ? "" : FaultOfSearch(figure);
  if (!fault.empty()) return fault;
  if (mean <= 0.0) return "the levels disagree by more than the probability";
  return unknown <= kMostUnknown * mean ? "" : UnknownText(unknown);
}

}  // namespace

RareFigure EstimateRareFigure(const RareEvidence& evidence) {
  RareFigure figure;
  std::vector<double> all_terms;
  double squared_error = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    const WeightedTrials& trials = evidence.cheap[i];
    const std::vector<double> terms = CheapTerms(trials, trials.weights);
    const RareLevel level = LevelOf(terms);
    const auto num = static_cast<double>(level.num);
    std::vector<double> own_terms = CheapTerms(trials, trials.own_weights);
    const RareLevel own = LevelOf(own_terms);
    for (double& term : own_terms) term /= num;
    figure.by_proposal[i] = IntervalOf(own.mean, own.variance / num, own_terms, own.num);
    figure.cheap.num += level.num;
    figure.cheap.mean += 0.5 * level.mean;
    figure.cheap.variance += 0.5 * level.variance;
    squared_error += 0.25 * level.variance / num;
    for (const double term : terms) all_terms.push_back(0.5 * term / num);
  }
  if (!evidence.pairs.weights.empty()) {
    constexpr double kMoreDisagreements = 2.0;
    const std::vector<double> terms = CorrectionTerms(evidence.pairs);
    figure.correction = LevelOf(terms, kMoreDisagreements * SquareOfDisagreement(evidence.pairs));
    const auto num = static_cast<double>(figure.correction.num);
    squared_error += figure.correction.variance / num;
    for (const double term : terms) all_terms.push_back(term / num);
  }
  const std::uint64_t num_dearest =
      evidence.pairs.weights.empty() ? figure.cheap.num : figure.correction.num;
  const std::uint64_t num_failed = NumFailed(evidence);
  const double unknown = UnknownShare(evidence);
  figure.is_plain = IsPlain(evidence);
  if (num_failed == 0 && unknown > 0.0) {
    figure.refusal = UnknownText(unknown);
    return figure;
  }
  if (num_failed == 0) {
    const double share_of_p = figure.is_plain ? 1.0 : kDefensiveShare;
    figure.at_most = ExactPoissonRate(0, share_of_p * static_cast<double>(num_dearest)).high;
    figure.refusal = figure.is_plain ? "nothing failed as drawn" : "nothing failed";
    return figure;
  }
  for (double& term : all_terms) term = std::abs(term);
  figure.largest_share = *std::ranges::max_element(all_terms) /
                         std::accumulate(all_terms.begin(), all_terms.end(), 0.0);
  figure.effective = EffectiveOf(all_terms);
  const double mean = figure.cheap.mean + figure.correction.mean;
  figure.refusal = RefusalOf(figure, mean, unknown);
  figure.probability = NotEnough(figure.cheap.num + figure.correction.num);
  if (figure.is_known()) {
    figure.probability = figure.is_plain
                             ? Proportion(num_failed, figure.cheap.num)
                             : IntervalOf(mean, squared_error, all_terms, figure.probability.num);
  }
  return figure;
}

double PlainTrialsFor(const Estimate& probability) {
  const double error = 0.5 * (probability.high - probability.low) / NormalQuantile();
  return probability.value * (1.0 - probability.value) / (error * error);
}

}  // namespace railcast
