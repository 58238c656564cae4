#include "analysis/estimate/two_sample.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/error.h"
#include "core/base/random.h"

namespace railcast {
namespace {

constexpr std::size_t kNumFolds = TwoSampleTest::kNumFolds;

// Runs of groups, as equal in their number of groups as can be.
std::vector<std::size_t> FoldsOf(const std::vector<std::uint32_t>& group) {
  std::vector<std::uint32_t> groups = group;
  std::ranges::sort(groups);
  groups.erase(std::ranges::unique(groups).begin(), groups.end());
  std::vector<std::size_t> folds;
  for (const std::uint32_t of_member : group) {
    const auto rank =
        static_cast<std::size_t>(std::ranges::lower_bound(groups, of_member) - groups.begin());
    folds.push_back(rank * kNumFolds / groups.size());
  }
  return folds;
}

bool HaveAllFolds(const std::vector<std::size_t>& folds, const std::vector<bool>& is_second) {
  std::vector<bool> has(2 * kNumFolds);
  for (std::size_t i = 0; i < folds.size(); ++i) has[2 * folds[i] + (is_second[i] ? 1 : 0)] = true;
  return std::ranges::count(has, true) == static_cast<std::ptrdiff_t>(has.size());
}

// The order in which the members of a part give their values to each other (Fisher and Yates).
std::vector<std::size_t> Shuffled(std::size_t num,
                                  std::uint64_t seed,
                                  std::uint32_t fold,
                                  std::uint32_t feature) {
  std::vector<std::size_t> order(num);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = 0; i + 1 < num; ++i) {
    const std::uint64_t word = RandomWords(seed, RandomUse::kLabelShuffle, fold,
                                           static_cast<std::uint32_t>(i), feature)[0];
    constexpr unsigned kWordBits = 32;
    std::swap(order[i], order[i + ((word * (num - i)) >> kWordBits)]);
  }
  return order;
}

// The forests of two folds have eight ninths of their groups in common, so that the folds' figures
// are not independent: the variance of their mean is that of independent ones times 1 + the ratio
// of held to grown groups x the number of folds (Nadeau and Bengio 2003, Machine Learning 52, the
// corrected resampled t test).
Estimate MeanOverFolds(const Moments& of_folds) {
  constexpr auto kFolds = static_cast<double>(kNumFolds);
  Estimate mean = of_folds.Mean();
  const double half = std::sqrt(1.0 + kFolds / (kFolds - 1.0)) * (mean.high - mean.value);
  mean.low = mean.value - half;
  mean.high = mean.value + half;
  return mean;
}

// The area under the curve of some members with their scores.
double AreaOf(const TwoSamples& samples,
              const std::vector<Eigen::Index>& members,
              const std::vector<double>& scores) {
  std::vector<double> first, second;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const bool is_second = samples.is_second[static_cast<std::size_t>(members[i])];
    (is_second ? second : first).push_back(scores[i]);
  }
  return AreaUnderCurve(std::move(first), second);
}

}  // namespace

double AreaUnderCurve(std::vector<double> first, const std::vector<double>& second) {
  if (first.empty() || second.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(first);
  double num_above = 0.0;
  for (const double score : second) {
    const auto [low, high] = std::ranges::equal_range(first, score);
    num_above += static_cast<double>(low - first.begin()) + 0.5 * static_cast<double>(high - low);
  }
  return num_above / static_cast<double>(first.size()) / static_cast<double>(second.size());
}

TwoSampleTest::TwoSampleTest(const TwoSamples& samples, std::uint64_t seed)
    : samples_(samples), fold_(FoldsOf(samples.group)) {
  const auto num = static_cast<std::size_t>(samples.features.rows());
  Check(samples.is_second.size() == num && samples.group.size() == num,
        "a row, a sample and a group for each member");
  std::vector<Moments> lost(static_cast<std::size_t>(samples.features.cols()));
  if (HaveAllFolds(fold_, samples.is_second)) {
    scores_.resize(num);
    for (std::uint32_t fold = 0; fold < kNumFolds; ++fold) ScoreFold(fold, seed, lost);
  }
  for (const Moments& of_feature : lost) importances_.push_back(MeanOverFolds(of_feature));
}

void TwoSampleTest::ScoreFold(std::uint32_t fold,
                              std::uint64_t seed,
                              std::vector<Moments>& lost_areas) {
  std::vector<Eigen::Index> grown, held;
  std::vector<bool> classes;
  for (std::size_t i = 0; i < fold_.size(); ++i) {
    (fold_[i] == fold ? held : grown).push_back(static_cast<Eigen::Index>(i));
    if (fold_[i] != fold) classes.push_back(samples_.is_second[i]);
  }
  const RandomForest forest(samples_.features(grown, Eigen::all), classes, seed + fold);
  Eigen::MatrixXd x = samples_.features(held, Eigen::all);
  const std::vector<double> scores = forest.Scores(x);
  for (std::size_t i = 0; i < scores.size(); ++i) {
    scores_[static_cast<std::size_t>(held[i])] = scores[i];
  }
  const double area = AreaOf(samples_, held, scores);
  for (std::size_t i = 0; i < lost_areas.size(); ++i) {
    const auto feature = static_cast<Eigen::Index>(i);
    const Eigen::VectorXd values = x.col(feature);
    x.col(feature) =
        values(Shuffled(scores.size(), seed, fold, static_cast<std::uint32_t>(feature)));
    lost_areas[i].Add(area - AreaOf(samples_, held, forest.Scores(x)));
    x.col(feature) = values;
  }
}

Estimate TwoSampleTest::OverFolds(const std::vector<double>& scores,
                                  const std::function<bool(std::size_t)>& takes_part) const {
  std::vector<std::vector<double>> first(kNumFolds), second(kNumFolds);
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (takes_part(i)) (samples_.is_second[i] ? second : first)[fold_[i]].push_back(scores[i]);
  }
  Moments areas;  // Ignores the folds that have none.
  for (std::size_t number = 0; number < kNumFolds; ++number) {
    areas.Add(AreaUnderCurve(std::move(first[number]), second[number]));
  }
  Estimate area = MeanOverFolds(areas);
  // An area is a probability; its interval need not reach beyond.
  area.low = std::max(area.low, 0.0);
  area.high = std::min(area.high, 1.0);
  return area;
}

Estimate TwoSampleTest::Area(const std::function<bool(std::size_t)>& takes_part) const {
  return OverFolds(scores_, takes_part);
}

Estimate TwoSampleTest::Area() const {
  return Area([](std::size_t) { return true; });
}

Estimate TwoSampleTest::BalancedAccuracy() const {
  // The area of yes and no is the mean of the shares that are right.
  constexpr double kAsLikelyAsNot = 0.5;
  std::vector<double> told;
  for (const double score : scores_) told.push_back(score > kAsLikelyAsNot ? 1.0 : 0.0);
  return OverFolds(told, [](std::size_t) { return true; });
}

}  // namespace railcast
