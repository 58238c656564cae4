#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "analysis/estimate/estimate.h"
#include "analysis/estimate/streams.h"

namespace railcast {

/// A random forest of two classes (Breiman 2001, Machine Learning 45): trees that are grown to
/// samples drawn with replacement, and that consider a few random features at each split.
///
/// Each tree draws as many samples of one class as of the other, so that the classes' sizes do not
/// matter (Chen, Liaw and Breiman 2004, "balanced random forest"). Splits minimise Gini's impurity,
/// among thresholds at 63 quantiles of each feature, and leave at least 5 samples on either side.
class RandomForest {
 public:
  /// Grows the trees in parallel; the forest does not depend on the number of threads.
  /// @param x One row for each sample, one column for each feature. NaN is a value below all
  ///   others, so that what is missing may tell, too.
  /// @param is_second The class of each sample.
  /// @param seed Of the draws, which are keyed by it, tree and draw.
  /// @pre Both classes have samples.
  RandomForest(const Eigen::MatrixXd& x, const std::vector<bool>& is_second, std::uint64_t seed);

  /// How much each row looks like the second class, 0 to 1: the mean over the trees of the share of
  /// that class in the row's leaf.
  [[nodiscard]] std::vector<double> Scores(const Eigen::MatrixXd& x) const;

  struct Node {
    int feature = -1;       ///< -1: a leaf.
    double threshold{};     ///< Rows that are not above it go to `child`, others to the next.
    std::uint32_t child{};  ///< Index of the first of the two children.
    double second_share{};  ///< In a leaf, the share of the second class.
  };
  using Tree = std::vector<Node>;  ///< The root first.

 private:
  std::vector<Tree> trees_;
};

/// The probability that a score of the second sample exceeds one of the first, equal ones counted
/// half: the area under the receiver operating characteristic, U / (m n) of Mann and Whitney
/// (1947). NaN if a sample is empty.
[[nodiscard]] double AreaUnderCurve(std::vector<double> first, const std::vector<double>& second);

/// Two samples whose members belong to groups, such as patches of two clouds by frame.
struct TwoSamples {
  Eigen::MatrixXd features;          ///< A row for each member; NaN is missing.
  std::vector<bool> is_second;       ///< By member.
  std::vector<std::uint32_t> group;  ///< By member; neighbouring numbers are alike.
};

/// How well a classifier tells two samples apart (Lopez-Paz and Oquab 2017, "Revisiting classifier
/// two-sample tests", ICLR): if they have one distribution, none can, and the area under the curve
/// is 0.5.
///
/// A random forest is grown to nine tenths of the groups and scores the members of the others, ten
/// times, so that no group is in both parts. The parts are runs of groups with neighbouring
/// numbers, since frames of one drive resemble their neighbours.
class TwoSampleTest {
 public:
  static constexpr std::size_t kNumFolds = 10;

  /// @pre `samples` outlives this.
  explicit TwoSampleTest(const TwoSamples& samples, std::uint64_t seed = 0);
  explicit TwoSampleTest(TwoSamples&&, std::uint64_t seed = 0) = delete;

  /// Whether there are enough groups, with members of both samples in every part. Without them all
  /// estimates are "not enough".
  [[nodiscard]] bool is_enough() const { return !scores_.empty(); }

  /// The area under the curve: mean over the ten parts with Student's interval, widened because
  /// the forests share most of what they are grown to (Nadeau and Bengio 2003, Machine Learning
  /// 52). It holds whatever the members of one part have in common, and takes the parts' members as
  /// independent of those of other parts.
  /// @param takes_part Of members, by index: which ones count. Parts without any of either sample
  ///   leave too few parts for an estimate.
  [[nodiscard]] Estimate Area(const std::function<bool(std::size_t)>& takes_part) const;
  [[nodiscard]] Estimate Area() const;
  /// The mean of the shares of both samples that are told right, over the ten parts.
  [[nodiscard]] Estimate BalancedAccuracy() const;
  /// For each feature, how much area is lost when its values are shuffled among the members of each
  /// part (permutation importance, Breiman 2001), over the ten parts. Of features that say the
  /// same, each may be small.
  [[nodiscard]] const std::vector<Estimate>& importances() const { return importances_; }

 private:
  void ScoreFold(std::uint32_t fold, std::uint64_t seed, std::vector<Moments>& lost_areas);
  [[nodiscard]] Estimate OverFolds(const std::vector<double>& scores,
                                   const std::function<bool(std::size_t)>& takes_part) const;

  const TwoSamples& samples_;
  std::vector<std::size_t> fold_;  ///< By member.
  std::vector<double> scores_;     ///< By member, of a forest that has not seen its group.
  std::vector<Estimate> importances_;
};

}  // namespace railcast
