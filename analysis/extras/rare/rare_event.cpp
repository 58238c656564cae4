#include "analysis/extras/rare/rare_event.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

namespace railcast {
namespace {

constexpr double kEliteShare = 0.1;
/// The share of failures among trials by p from which on no other law saves as much as its search
/// costs.
constexpr double kFrequentShare = 0.05;

/// Where trials that were drawn by one proposal lie among all.
struct Batch {
  std::vector<std::uint32_t> indices;
};

/// q / p of the figure's proposals at the point of a trial.
struct Densities {
  std::array<double, 2> of_cheap{};
  double of_pairs{};
};

// Unknown results are no failures that a search could go for.
double SoughtScore(const RareScores& scores) {
  return std::isnan(scores.cheap) ? std::numeric_limits<double>::infinity() : scores.cheap;
}

/// One run, whose trials are made by an experiment.
class RareRunner {
 public:
  RareRunner(const std::vector<RareFactor>& factors,
             const RareSettings& settings,
             const RareExperiment& experiment)
      : factors_(factors), settings_(settings), experiment_(experiment) {}

  std::optional<RareRun> Run() {
    const std::uint32_t num_pilot = std::max(settings_.num_per_stage / 2, 1U);
    proposals_.fill({.factors = factors_});
    Batch first;
    if (!Try(proposals_[0], settings_.num_per_stage, false, first)) return std::nullopt;
    if (ScoreAt(kFrequentShare, first) < 0.0) {
      const auto middle = first.indices.begin() + static_cast<std::ptrdiff_t>(num_pilot);
      cheap_ = {Batch{{first.indices.begin(), middle}}, Batch{{middle, first.indices.end()}}};
    } else {
      const std::uint32_t quarter = settings_.most_trials / 4;
      if (!Search(proposals_[0], first, quarter) || !Search(proposals_[1], {}, 2 * quarter)) {
        return std::nullopt;
      }
      run_.num_searching = static_cast<std::uint32_t>(run_.trials.size());
      for (std::size_t i = 0; i < 2; ++i) {
        if (!TryFor(i, num_pilot)) return std::nullopt;
      }
    }
    if (settings_.has_pairs) {
      pair_proposal_ = FitProposal(factors_, NearTheEdge(), FitSeed());
      if (!Try(pair_proposal_, num_pilot, true, pairs_)) return std::nullopt;
    }
    run_.figure = EstimateRareFigure(Evidence());
    while (auto more = MoreTrials()) {
      if (PlainIsCheaper()) {
        // Anew, so that what decided this is no part of the figure.
        proposals_.fill({.factors = factors_});
        cheap_ = {};
        run_.num_searching = static_cast<std::uint32_t>(run_.trials.size());
        own_ = {};
        more = Numbers{.num_cheap = 2 * num_pilot};
      }
      for (std::size_t i = 0; i < 2; ++i) {
        if (!TryFor(i, more->num_cheap / 2)) return std::nullopt;
      }
      if (!Try(pair_proposal_, more->num_pairs, true, pairs_) || !TryOwn(more->num_own)) {
        return std::nullopt;
      }
      run_.figure = EstimateRareFigure(Evidence());
    }
    run_.num_own = static_cast<std::uint32_t>(own_.indices.size());
    for (std::uint32_t i = run_.num_searching; i < run_.trials.size(); ++i) {
      run_.trials[i].weight = WeightAmong(run_.trials[i].is_pair, i);
    }
    return std::move(run_);
  }

 private:
  struct Numbers {
    std::uint32_t num_cheap{};
    std::uint32_t num_pairs{};
    std::uint32_t num_own{};
  };

  // The seed of a fit that follows the trials made so far.
  [[nodiscard]] std::uint64_t FitSeed() const { return settings_.seed + run_.trials.size(); }

  // Moves a proposal, which starts as p, towards the failures. Returns false if it was stopped.
  // @param batch The first stage, if it was made.
  // @param most_trials After these, there is no further stage.
  bool Search(Proposal& proposal, Batch batch, std::uint32_t most_trials) {
    constexpr std::size_t kMostStages = 12;
    constexpr double kEnoughFailures = 30.0;  // To fit modes to.
    std::vector<Proposal> stages;
    Batch all;
    const auto has_room = [&] {
      return stages.empty() || run_.trials.size() + settings_.num_per_stage <= most_trials;
    };
    for (; stages.size() < kMostStages && has_room(); batch = {}) {
      if (batch.indices.empty() && !Try(proposal, settings_.num_per_stage, false, batch)) {
        return false;
      }
      all.indices.insert(all.indices.end(), batch.indices.begin(), batch.indices.end());
      stages.push_back(proposal);
      const double threshold = ScoreAt(kEliteShare, batch);
      if (std::isinf(threshold)) return true;  // Next to nothing can fail.
      Batch elite;
      std::ranges::copy_if(all.indices, std::back_inserter(elite.indices),
                           [&](std::uint32_t index) {
                             const double score = SoughtScore(run_.scores[index]);
                             return threshold < 0.0 ? score < 0.0 : score <= threshold;
                           });
      WeightedPoints points = PointsOf(elite);
      for (std::size_t i = 0; i < points.points.size(); ++i) {
        points.weights[i] = WeightOfAll(stages, points.points[i]);
      }
      proposal = FitProposal(factors_, points, FitSeed());
      if (threshold < 0.0 && EffectiveOf(points.weights) >= kEnoughFailures) return true;
    }
    return true;
  }

  // The score that a share of the trials are below.
  [[nodiscard]] double ScoreAt(double share, const Batch& batch) const {
    std::vector<double> scores;
    for (const std::uint32_t index : batch.indices) {
      scores.push_back(SoughtScore(run_.scores[index]));
    }
    const auto place =
        scores.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(scores.size()));
    std::nth_element(scores.begin(), place, scores.end());
    return *place;
  }

  // The weight of a point that any of several proposals may have drawn, each with equal
  // probability.
  static double WeightOfAll(std::span<const Proposal> proposals, const RarePoint& point) {
    double sum = 0.0;
    for (const Proposal& proposal : proposals) sum += 1.0 / WeightOf(proposal, point);
    return static_cast<double>(proposals.size()) / sum;
  }

  // The failures of the pilot, and so many others with the lowest scores as are as probable.
  [[nodiscard]] WeightedPoints NearTheEdge() const {
    Batch near;
    for (const Batch& batch : cheap_) {
      near.indices.insert(near.indices.end(), batch.indices.begin(), batch.indices.end());
    }
    const auto score_of = [&](std::uint32_t index) { return SoughtScore(run_.scores[index]); };
    std::ranges::stable_sort(near.indices, {}, score_of);
    double failed = 0.0;
    double sum = 0.0;
    std::size_t num = 0;
    while (num < near.indices.size() && (score_of(near.indices[num]) < 0.0 || sum < 2.0 * failed)) {
      const std::uint32_t index = near.indices[num++];
      sum += run_.trials[index].weight;
      if (score_of(index) < 0.0) failed = sum;
    }
    near.indices.resize(num);
    return PointsOf(near);
  }

  [[nodiscard]] WeightedPoints PointsOf(const Batch& batch) const {
    WeightedPoints points;
    for (const std::uint32_t index : batch.indices) {
      points.points.push_back(run_.trials[index].point);
      points.weights.push_back(run_.trials[index].weight);
    }
    return points;
  }

  // Whether anything draws otherwise than p.
  [[nodiscard]] bool HasModes() const {
    return !pair_proposal_.modes.empty() ||
           std::ranges::any_of(proposals_,
                               [](const Proposal& each) { return !each.modes.empty(); });
  }

  // By how many trials of a level the point of a trial would be met, if it were all that p draws.
  [[nodiscard]] double MetBy(bool on_pairs, std::uint32_t index) const {
    const Densities& densities = densities_[index];
    const auto num_of = [](const Batch& batch) {
      return static_cast<double>(batch.indices.size());
    };
    const double by_own = on_pairs == settings_.has_pairs ? num_of(own_) : 0.0;
    if (on_pairs) return by_own + num_of(pairs_) * densities.of_pairs;
    return by_own + num_of(cheap_[0]) * densities.of_cheap[0] +
           num_of(cheap_[1]) * densities.of_cheap[1];
  }

  // The number of trials by all laws of a level.
  [[nodiscard]] double NumOf(bool is_pair) const {
    std::size_t num =
        is_pair ? pairs_.indices.size() : cheap_[0].indices.size() + cheap_[1].indices.size();
    if (is_pair == settings_.has_pairs) num += own_.indices.size();
    return static_cast<double>(num);
  }

  [[nodiscard]] double WeightAmong(bool on_pairs, std::uint32_t index) const {
    return NumOf(on_pairs) / MetBy(on_pairs, index);
  }

  [[nodiscard]] WeightedTrials TrialsOf(const Batch& batch, bool is_pair) const {
    WeightedTrials trials;
    for (const std::uint32_t index : batch.indices) {
      trials.weights.push_back(WeightAmong(is_pair, index));
      trials.scores.push_back(run_.scores[index]);
    }
    return trials;
  }

  [[nodiscard]] RareEvidence Evidence() const {
    RareEvidence evidence{
        {TrialsOf(cheap_[0], false), TrialsOf(cheap_[1], false)}, {TrialsOf(pairs_, true)}, Own()};
    WeightedTrials own = TrialsOf(own_, settings_.has_pairs);
    (settings_.has_pairs ? evidence.pairs[1] : evidence.cheap[2]) = std::move(own);
    for (std::size_t i = 0; i < 2; ++i) {
      for (const std::uint32_t index : cheap_[i].indices) {
        evidence.cheap[i].own_weights.push_back(1.0 / densities_[index].of_cheap[i]);
      }
    }
    return evidence;
  }

  // All trials of the figure that p has drawn on the dearest level.
  [[nodiscard]] OwnTrials Own() const {
    OwnTrials own;
    if (!HasModes()) return own;
    const auto add = [&](std::uint32_t index) {
      own.scores.push_back(run_.scores[index]);
      own.cheap_weights.push_back(WeightAmong(false, index));
      if (settings_.has_pairs) own.pair_weights.push_back(WeightAmong(true, index));
    };
    const auto add_by_p = [&](const Proposal& proposal, const Batch& batch) {
      for (const std::uint32_t index : batch.indices) {
        if (IsDrawnByP(proposal, settings_.seed, index)) add(index);
      }
    };
    if (settings_.has_pairs) {
      add_by_p(pair_proposal_, pairs_);
    } else {
      for (std::size_t i = 0; i < 2; ++i) add_by_p(proposals_[i], cheap_[i]);
    }
    for (const std::uint32_t index : own_.indices) add(index);
    return own;
  }

  // How many trials of a level are needed, of which so many reach the wanted error.
  [[nodiscard]] double WantedOf(const RareLevel& level, double for_error) const {
    constexpr double kWantedEffective = 120.0;
    constexpr double kWantedLargest = 0.04;  // Share of one trial.
    const RareFigure& figure = run_.figure;
    if (!figure.rests_on_search) return for_error;
    const auto num = static_cast<double>(level.num);
    return std::max({for_error, num * kWantedEffective / std::max(figure.effective, 1.0),
                     num * figure.largest_share / kWantedLargest});
  }

  [[nodiscard]] double Mean() const {
    const RareFigure& figure = run_.figure;
    return figure.cheap.mean + figure.correction.mean + figure.beyond.mean();
  }

  // The level of the trials by proposals, with what those by p add to the mean.
  [[nodiscard]] RareLevel ByProposals(bool is_pair) const {
    const RareFigure& figure = run_.figure;
    RareLevel level = is_pair ? figure.correction : figure.cheap;
    if (level.num == 0 || is_pair != settings_.has_pairs) return level;
    const std::uint64_t num = level.num - own_.indices.size();
    level.variance *= static_cast<double>(num) / static_cast<double>(level.num);
    level.num = num;
    return level;
  }

  // The variance of one trial by p, at the points that the proposals hardly draw.
  [[nodiscard]] double VarianceBeyond() const {
    const RareBeyond& beyond = run_.figure.beyond;
    if (beyond.num == 0) return 0.0;
    return static_cast<double>(beyond.num_more + beyond.num_fewer) /
           static_cast<double>(beyond.num);
  }

  // The cost of a trial on the dearest level.
  [[nodiscard]] double DearestCost() const {
    return settings_.has_pairs ? settings_.pair_cost : 1.0;
  }

  // The sum over all levels of the roots of variance times cost, over the square of the wanted
  // error.
  [[nodiscard]] double Effort() const {
    const double error = settings_.precision * Mean() / NormalQuantile();
    return (std::sqrt(ByProposals(false).variance) +
            std::sqrt(ByProposals(true).variance * DearestCost()) +
            std::sqrt(VarianceBeyond() * DearestCost())) /
           (error * error);
  }

  // How many trials by p are asked for: of failures as frequent as 3 / n, one is met, with 95 %.
  [[nodiscard]] double Asked() const {
    constexpr double kRuleOfThree = 3.0;
    return settings_.unseen ? std::ceil(kRuleOfThree / *settings_.unseen) : 0.0;
  }

  // How many trials by p there should be beside the proposals.
  [[nodiscard]] double WantedOwn() const {
    // If none of n trials fails, at most 3.7 / n of all do, with 97.5 %.
    constexpr double kNoneOfMany = 3.689;
    if (!HasModes()) return 0.0;
    const auto for_error = [&] { return std::sqrt(VarianceBeyond() / DearestCost()) * Effort(); };
    if (OnlyOwnFail()) return std::max(for_error(), Asked());
    if (settings_.unseen) return Asked();
    const auto num_own = static_cast<double>(own_.indices.size());
    const auto num_pairs = static_cast<double>(pairs_.indices.size());
    const double others =
        (static_cast<double>(run_.trials.size()) - num_own - num_pairs) / DearestCost() + num_pairs;
    const double num_by_others = static_cast<double>(run_.figure.beyond.num) - num_own;
    if (Mean() <= 0.0) return num_by_others + others;
    return std::min(std::max(for_error(), kNoneOfMany / (settings_.precision * Mean())),
                    num_by_others + others);
  }

  // Whether trials by p alone are fewer than what the figure still lacks: where what is no factor
  // decides, no proposal helps.
  [[nodiscard]] bool PlainIsCheaper() const {
    const RareLevel level = ByProposals(false);
    const double mean = Mean();
    const bool has_room = run_.trials.size() + settings_.num_per_stage <= settings_.most_trials;
    if (settings_.has_pairs || run_.figure.is_plain || !has_room) return false;
    if (level.mean <= 0.0) return HasLostFailures();
    const double error = settings_.precision * mean / NormalQuantile();
    const double lacking = WantedOf(level, std::sqrt(level.variance) * Effort()) -
                           static_cast<double>(level.num) +
                           std::max(WantedOwn() - static_cast<double>(run_.figure.beyond.num), 0.0);
    return std::max(mean * (1.0 - mean) / (error * error), Asked()) < lacking;
  }

  // Whether nothing fails that the proposals draw, but some of what p draws does.
  [[nodiscard]] bool OnlyOwnFail() const {
    return run_.figure.cheap.mean <= 0.0 && run_.figure.beyond.num_more > 0 && Mean() > 0.0;
  }

  // Whether the searches met failures that nothing has met again.
  [[nodiscard]] bool HasLostFailures() const {
    return run_.figure.cheap.mean <= 0.0 && run_.figure.beyond.num_more == 0 &&
           std::ranges::any_of(run_.scores,
                               [](const RareScores& scores) { return scores.cheap < 0.0; });
  }

  // How many more trials of a level are needed.
  [[nodiscard]] std::uint32_t MoreOf(const RareLevel& level, double cost) const {
    constexpr double kMostGrowth = 4.0;  // A pilot may err.
    constexpr double kEnough = 1.0 / 1.05;
    if (run_.figure.cheap.mean <= 0.0 || Mean() <= 0.0 || level.num == 0) return 0;
    const auto num = static_cast<double>(level.num);
    const double wanted = WantedOf(level, std::sqrt(level.variance / cost) * Effort());
    if (kEnough * wanted <= num) return 0;
    return static_cast<std::uint32_t>(
        std::ceil(std::min({wanted - num, (kMostGrowth - 1.0) * num, Room()})));
  }

  [[nodiscard]] double Room() const {
    return static_cast<double>(settings_.most_trials) - static_cast<double>(run_.trials.size());
  }

  // How many more are needed; nothing if there are enough, or if more would not help.
  [[nodiscard]] std::optional<Numbers> MoreTrials() const {
    const RareFigure& figure = run_.figure;
    if (Room() <= 0.0) return std::nullopt;
    Numbers more{MoreOf(ByProposals(false), 1.0), MoreOf(ByProposals(true), DearestCost())};
    if (!settings_.has_pairs && HasLostFailures()) {
      more.num_cheap =
          static_cast<std::uint32_t>(std::min(3.0 * static_cast<double>(figure.cheap.num), Room()));
    }
    if (!HasModes()) {
      const double lacking = std::clamp(Asked() - NumOf(settings_.has_pairs), 0.0, Room());
      std::uint32_t& by_p = settings_.has_pairs ? more.num_pairs : more.num_cheap;
      by_p = std::max(by_p, static_cast<std::uint32_t>(lacking));
    }
    more.num_cheap += more.num_cheap % 2;
    more.num_own = static_cast<std::uint32_t>(
        std::clamp(WantedOwn() - static_cast<double>(figure.beyond.num), 0.0, Room()));
    // What is asked for by --unseen comes first.
    double room = Room();
    if (settings_.unseen) room -= more.num_own;
    const double wanted = static_cast<double>(more.num_cheap) + more.num_pairs +
                          (settings_.unseen ? 0 : more.num_own);
    if (wanted > room) {
      const auto part = [&](std::uint32_t num) {
        return static_cast<std::uint32_t>(num * room / wanted);
      };
      more = {part(more.num_cheap), part(more.num_pairs),
              settings_.unseen ? more.num_own : part(more.num_own)};
      more.num_cheap -= more.num_cheap % 2;
    }
    if (more.num_cheap + more.num_pairs + more.num_own == 0) return std::nullopt;
    return more;
  }

  // Draws and tries more of the figure's cheap trials by one of its proposals. Returns false if it
  // was stopped.
  bool TryFor(std::size_t proposal, std::uint32_t num) {
    const std::size_t begin = run_.trials.size();
    if (!Try(proposals_[proposal], num, false, cheap_[proposal])) return false;
    for (std::size_t i = begin; i < run_.trials.size(); ++i) {
      run_.trials[i].weight = WeightOfAll(proposals_, run_.trials[i].point);
    }
    return true;
  }

  // Draws and tries more of the trials by p. Returns false if it was stopped.
  bool TryOwn(std::uint32_t num) {
    return Try({.factors = factors_}, num, settings_.has_pairs, own_);
  }

  // Draws and tries points. Returns false if it was stopped.
  bool Try(const Proposal& proposal, std::uint32_t num, bool is_pair, Batch& batch) {
    if (num == 0) return true;
    std::vector<RareTrial> trials;
    for (std::uint32_t i = 0; i < num; ++i) {
      const auto index = static_cast<std::uint32_t>(run_.trials.size()) + i;
      RareTrial trial{.index = index, .point = DrawPoint(proposal, settings_.seed, index)};
      trial.weight = WeightOf(proposal, trial.point);
      densities_.push_back(
          {{1.0 / WeightOf(proposals_[0], trial.point), 1.0 / WeightOf(proposals_[1], trial.point)},
           1.0 / WeightOf(pair_proposal_, trial.point)});
      trial.is_pair = is_pair;
      trials.push_back(std::move(trial));
      batch.indices.push_back(index);
    }
    const auto scores = experiment_(trials);
    if (!scores) return false;
    run_.scores.insert(run_.scores.end(), scores->begin(), scores->end());
    std::ranges::move(trials, std::back_inserter(run_.trials));
    return true;
  }

  const std::vector<RareFactor>& factors_;
  const RareSettings& settings_;
  const RareExperiment& experiment_;
  std::array<Proposal, 2> proposals_;
  Proposal pair_proposal_;
  std::array<Batch, 2> cheap_;
  Batch pairs_;
  Batch own_;
  std::vector<Densities> densities_;  ///< For all trials.
  RareRun run_;
};

}  // namespace

std::optional<RareRun> RunRareEvent(const std::vector<RareFactor>& factors,
                                    const RareSettings& settings,
                                    const RareExperiment& experiment) {
  return RareRunner(factors, settings, experiment).Run();
}

}  // namespace railcast
