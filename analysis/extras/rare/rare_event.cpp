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
/// Of failures among trials by p, from which on no other law saves as much as its search costs.
constexpr double kFrequentShare = 0.05;

/// Where trials that were drawn by one proposal lie among all.
struct Batch {
  std::vector<std::uint32_t> indices;
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
        more->num_cheap = 2 * num_pilot;
      }
      for (std::size_t i = 0; i < 2; ++i) {
        if (!TryFor(i, more->num_cheap / 2)) return std::nullopt;
      }
      if (!Try(pair_proposal_, more->num_pairs, true, pairs_)) return std::nullopt;
      run_.figure = EstimateRareFigure(Evidence());
    }
    return std::move(run_);
  }

 private:
  struct Numbers {
    std::uint32_t num_cheap{};
    std::uint32_t num_pairs{};
  };

  // Of a fit that follows the trials that there are.
  [[nodiscard]] std::uint64_t FitSeed() const { return settings_.seed + run_.trials.size(); }

  // Moves a proposal, which is p yet, to the failures. Returns false if it was stopped.
  // @param batch The first stage, if it was made.
  // @param most_trials After which there is no further stage.
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

  // Of a point that any of several proposals may have drawn, as often each.
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

  [[nodiscard]] WeightedTrials TrialsOf(const Batch& batch) const {
    WeightedTrials trials;
    for (const std::uint32_t index : batch.indices) {
      trials.weights.push_back(run_.trials[index].weight);
      trials.scores.push_back(run_.scores[index]);
    }
    return trials;
  }

  [[nodiscard]] RareEvidence Evidence() const {
    RareEvidence evidence{{TrialsOf(cheap_[0]), TrialsOf(cheap_[1])}, TrialsOf(pairs_)};
    for (std::size_t i = 0; i < 2; ++i) {
      for (const std::uint32_t index : cheap_[i].indices) {
        evidence.cheap[i].own_weights.push_back(WeightOf(proposals_[i], run_.trials[index].point));
      }
    }
    return evidence;
  }

  // How many trials of a level are needed, of which so many reach the wanted error.
  [[nodiscard]] double WantedOf(const RareLevel& level, double for_error) const {
    constexpr double kWantedEffective = 120.0;
    constexpr double kWantedLargest = 0.04;  // Share of one trial.
    const RareFigure& figure = run_.figure;
    if (figure.is_plain) return for_error;
    const auto num = static_cast<double>(level.num);
    return std::max({for_error, num * kWantedEffective / std::max(figure.effective, 1.0),
                     num * figure.largest_share / kWantedLargest});
  }

  // Whether trials by p are fewer than what the figure still lacks: where what is no factor
  // decides, no proposal helps.
  [[nodiscard]] bool PlainIsCheaper() const {
    const RareLevel& level = run_.figure.cheap;
    const bool has_room = run_.trials.size() + settings_.num_per_stage <= settings_.most_trials;
    if (settings_.has_pairs || run_.figure.is_plain || !has_room) return false;
    if (level.mean <= 0.0) return true;
    const double error = settings_.precision * level.mean / NormalQuantile();
    const double lacking =
        WantedOf(level, level.variance / (error * error)) - static_cast<double>(level.num);
    return level.mean * (1.0 - level.mean) / (error * error) < lacking;
  }

  [[nodiscard]] bool HasMetFailures() const {
    return std::ranges::any_of(run_.scores,
                               [](const RareScores& scores) { return scores.cheap < 0.0; });
  }

  // How many more are needed; nothing if there are enough, or if more would not help.
  [[nodiscard]] std::optional<Numbers> MoreTrials() const {
    constexpr double kMostGrowth = 4.0;  // A pilot may err.
    constexpr double kEnough = 1.0 / 1.05;
    const RareFigure& figure = run_.figure;
    const double mean = figure.cheap.mean + figure.correction.mean;
    const auto num_trials = static_cast<std::uint32_t>(run_.trials.size());
    if (num_trials >= settings_.most_trials) return std::nullopt;
    if (figure.cheap.mean <= 0.0 && !settings_.has_pairs && HasMetFailures()) {
      const auto more =
          static_cast<std::uint32_t>((kMostGrowth - 1.0) * static_cast<double>(figure.cheap.num));
      const std::uint32_t num = std::min(more, settings_.most_trials - num_trials);
      return num < 2 ? std::nullopt : std::optional(Numbers{num - num % 2, 0});
    }
    if (figure.cheap.mean <= 0.0 || mean <= 0.0) return std::nullopt;
    const double error = settings_.precision * mean / NormalQuantile();
    const double pair_cost = settings_.has_pairs ? settings_.pair_cost : 0.0;
    const double sum =
        std::sqrt(figure.cheap.variance) + std::sqrt(figure.correction.variance * pair_cost);
    const auto more_of = [&](const RareLevel& level, double cost) {
      const auto num = static_cast<double>(level.num);
      const double wanted =
          WantedOf(level, std::sqrt(level.variance / std::max(cost, 1.0)) * sum / (error * error));
      if (kEnough * wanted <= num) return 0U;
      const double most = std::min((kMostGrowth - 1.0) * num,
                                   static_cast<double>(settings_.most_trials - num_trials));
      return static_cast<std::uint32_t>(std::ceil(std::clamp(wanted - num, 0.0, most)));
    };
    Numbers more{more_of(figure.cheap, 1.0), 0};
    more.num_cheap += more.num_cheap % 2;
    if (settings_.has_pairs) more.num_pairs = more_of(figure.correction, pair_cost);
    const std::uint64_t room = settings_.most_trials - num_trials;
    const std::uint64_t wanted = std::uint64_t{more.num_cheap} + more.num_pairs;
    if (wanted > room) {
      more.num_cheap = static_cast<std::uint32_t>(more.num_cheap * room / wanted);
      more.num_pairs = static_cast<std::uint32_t>(more.num_pairs * room / wanted);
      more.num_cheap -= more.num_cheap % 2;
    }
    if (more.num_cheap + more.num_pairs == 0) return std::nullopt;
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

  // Draws and tries points. Returns false if it was stopped.
  bool Try(const Proposal& proposal, std::uint32_t num, bool is_pair, Batch& batch) {
    if (num == 0) return true;
    std::vector<RareTrial> trials;
    for (std::uint32_t i = 0; i < num; ++i) {
      const auto index = static_cast<std::uint32_t>(run_.trials.size()) + i;
      RareTrial trial{.index = index, .point = DrawPoint(proposal, settings_.seed, index)};
      trial.weight = WeightOf(proposal, trial.point);
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
  RareRun run_;
};

}  // namespace

std::optional<RareRun> RunRareEvent(const std::vector<RareFactor>& factors,
                                    const RareSettings& settings,
                                    const RareExperiment& experiment) {
  return RareRunner(factors, settings, experiment).Run();
}

}  // namespace railcast
