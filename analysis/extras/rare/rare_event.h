#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "analysis/estimate/estimate.h"
#include "analysis/extras/rare/proposal.h"

namespace railcast {

/// What became of a trial: negative if it failed, the more so the worse; NaN if that is not known.
struct RareScores {
  double cheap = std::numeric_limits<double>::quiet_NaN();
  double dear = std::numeric_limits<double>::quiet_NaN();  ///< For pairs only.
};

/// Trials that were drawn by one law.
struct WeightedTrials {
  std::vector<double> weights{};  ///< p / q, where q is the mean of all laws of the level.
  std::vector<RareScores> scores{};
  std::vector<double> own_weights{};  ///< For cheap trials: p / q by the proposal that drew them.
};

/// The mean over independent trials.
struct RareLevel {
  std::uint64_t num{};
  double mean{};
  double variance{};  ///< Variance of one trial.
};

/// Trials that p has drawn, on the dearest level, with the weights that their points have on both.
struct OwnTrials {
  std::vector<RareScores> scores{};
  std::vector<double> cheap_weights{};
  std::vector<double> pair_weights{};  ///< Empty with one level only.
};

/// All that a figure rests on.
struct RareEvidence {
  /// By two proposals that were found independently, as many by each, and by p.
  std::array<WeightedTrials, 3> cheap{};
  /// Tried on both levels, by a third proposal and by p; empty with one level only.
  std::array<WeightedTrials, 2> pairs{};
  /// All of these that p has drawn, also as its share in a proposal; empty if p has drawn all.
  OwnTrials own{};
};

/// What trials by p say of the points that no proposal draws as often.
struct RareBeyond {
  std::uint64_t num{};        ///< All trials by p.
  std::uint64_t num_more{};   ///< Failures that add to the probability, on the level that decides.
  std::uint64_t num_fewer{};  ///< Failures that the dear level says are none.
  /// (more - fewer) / num, with the exact intervals of both. What was not met at all is within it.
  Estimate share{};

  [[nodiscard]] double mean() const { return num > 0 ? share.value : 0.0; }
};

/// The probability of failure.
struct RareFigure {
  Estimate probability{};  ///< Not enough where it is refused.
  std::string refusal{};   ///< Why there is no figure; empty if there is one.
  Estimate met{};          ///< Its part at points that the proposals draw; as above.
  RareBeyond beyond{};     ///< The rest.
  /// Upper 95 % bound where nothing failed, by the trials that p had drawn; else NaN.
  double at_most = std::numeric_limits<double>::quiet_NaN();
  // For the part that was met:
  double effective{};      ///< Number of equal weights with as much error.
  double largest_share{};  ///< Share of one trial in the sum of all weights that count.
  std::array<Estimate, 2> by_proposal{};  ///< On the cheap level, by each alone.
  RareLevel cheap{};
  RareLevel correction{};  ///< Dear minus cheap.
  bool is_plain{};         ///< Whether p has drawn all, on one level: a share of equal trials.
  /// Whether the proposals meet as much of the probability as the rest, so that they must be sound.
  bool rests_on_search{};

  [[nodiscard]] bool is_known() const { return refusal.empty(); }
};

/// Estimates the probability of failure on the dear level in two parts.
///
/// At points that all laws together draw at least twice as often as p does, it is mean(w 1(cheap
/// fails)) over the cheap trials plus mean(w (1(dear fails) - 1(cheap fails))) over the pairs (two
/// levels; Giles 2015, Acta Numerica 24), with Fay and Feuer's interval (1997, Statistics in
/// Medicine 16) of the variances of both means, whose upper end allows for one more failure of the
/// largest weight of those met (theirs: of all), and is no nearer than that of a normal law. The
/// variance of the correction counts two disagreements more than were seen, so that it is not 0
/// where none was (rule of three). A trial is weighed as one that any of the level's laws may have
/// drawn (the balance heuristic; Veach and Guibas 1995), so that a kind of failure that one of them
/// has missed has no great weights.
///
/// At all other points, it is the share of the trials by p that failed there, with Clopper and
/// Pearson's interval (1934, Biometrika 26): of none in n, up to 3.7 / n. A kind of failure that
/// gives the searches no slope to follow is met there, or is within that interval. The intervals of
/// both parts are joined by the squares of their distances (Donner and Zou 2012, Statistical
/// Methods in Medical Research 21).
///
/// Of trials that p has drawn, on one level, it is the share that failed, with Wilson's interval.
/// Otherwise, unless the second part is the greater one, there is no figure if the intervals of the
/// two proposals do not overlap, if fewer than 100 weights are effective, or if one is more than
/// 5 % of their sum; nor, in any case, if nothing failed, or if trials whose result is not known
/// weigh more than a tenth of those that failed.
[[nodiscard]] RareFigure EstimateRareFigure(const RareEvidence& evidence);

/// Number of plain trials whose interval is as wide as that of a figure.
[[nodiscard]] double PlainTrialsFor(const Estimate& probability);

/// One trial of an experiment.
struct RareTrial {
  std::uint32_t index{};  ///< Its number, from which all follows that is random beside the point.
  RarePoint point{};
  /// p / q by what drew it; of trials for the figure, once they are tried, as in WeightedTrials.
  double weight{};
  bool is_pair{};  ///< Whether it is tried on both levels.
};

/// Tries all of a list, and returns their scores in that order; nothing if it was stopped.
using RareExperiment =
    std::function<std::optional<std::vector<RareScores>>(const std::vector<RareTrial>& trials)>;

struct RareSettings {
  std::uint64_t seed{};
  std::uint32_t num_per_stage = 300;  ///< Trials of each stage; an eighth of most_trials at most.
  double precision = 0.3;             ///< Half the interval, as a share of the probability.
  /// As often as what fails must, so as to be met by one of the trials by p with 95 %; at least 12
  /// / most_trials. Absent: as is worth it.
  std::optional<double> unseen{};
  std::uint32_t most_trials = 20'000;  ///< After which no more are added.
  bool has_pairs{};                    ///< Whether there is a dear level.
  double pair_cost = 3.0;              ///< Cost of a pair, in trials on the cheap level.
};

/// What a run has found, and all of its trials.
struct RareRun {
  RareFigure figure;
  std::vector<RareTrial> trials{};
  std::vector<RareScores> scores{};
  std::uint32_t num_searching{};  ///< How many of the first trials looked for the failures.
  std::uint32_t num_own{};        ///< Other trials, by p, for what the proposals miss.
};

/// Estimates a small probability of failure by importance sampling over the factors.
///
/// Where a twentieth of a first stage by p fails, that stage is part of the figure, and p draws
/// all. Otherwise two searches, independent of each other, move a proposal to the failures on the
/// cheap level in stages: each fits it to the tenth of the trials with the lowest scores, until
/// that tenth fails (cross-entropy; Rubinstein and Kroese 2004). Trials by both proposals, and
/// pairs by a third one that has been fitted to trials with scores near 0, give the figure. Their
/// numbers go by sqrt(variance / cost) of a pilot (Giles 2015), until the interval has the width
/// asked for. Trials by p, on the dearest level, then seek what the proposals miss: 3 / unseen of
/// them, or until what they cannot exclude is within that width, but at most for the time of all
/// others; where they alone meet failures, until the interval has that width. On one level, p draws
/// all anew where that takes fewer trials, or where failures that the searches met are not met
/// again; of these, too, there are 3 / unseen. The result is a function of the arguments and scores
/// alone.
/// @return Nothing if the experiment was stopped.
[[nodiscard]] std::optional<RareRun> RunRareEvent(const std::vector<RareFactor>& factors,
                                                  const RareSettings& settings,
                                                  const RareExperiment& experiment);

}  // namespace railcast
