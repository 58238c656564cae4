#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

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
    double second_share{};  ///< Of a leaf.
  };
  using Tree = std::vector<Node>;  ///< The root first.

 private:
  std::vector<Tree> trees_;
};

}  // namespace railcast
