#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace railcast {

/// The probability that the greater score is that of the second class, ties as half: the area under
/// the receiver operating characteristic.
[[nodiscard]] inline double AreaUnderCurve(std::span<const double> scores,
                                           const std::vector<bool>& is_second) {
  std::vector<std::size_t> order(scores.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return scores[i]; });
  double rank_sum = 0.0;
  double num_second = 0.0;
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin;
    while (end < order.size() && scores[order[end]] == scores[order[begin]]) ++end;
    const double mean_rank = 0.5 * static_cast<double>(begin + 1 + end);
    for (; begin < end; ++begin) {
      if (!is_second[order[begin]]) continue;
      rank_sum += mean_rank;
      num_second += 1.0;
    }
  }
  const double num_first = static_cast<double>(scores.size()) - num_second;
  return (rank_sum - 0.5 * num_second * (num_second + 1.0)) / (num_first * num_second);
}

/// A row of features for each sample, the class of each, and the part in which it is scored.
struct TwoSamples {
  std::vector<std::vector<double>> features;
  std::vector<bool> is_second;
  std::vector<std::size_t> part;

  /// The sample goes to the next of five parts.
  void Add(std::vector<double> row, bool second) { Add(std::move(row), second, part.size() % 5); }
  /// @param of_object Part of all samples that have something in common, such as their object.
  void Add(std::vector<double> row, bool second, std::size_t of_object) {
    features.push_back(std::move(row));
    is_second.push_back(second);
    part.push_back(of_object);
  }
  [[nodiscard]] std::vector<double> Column(std::size_t k) const {
    std::vector<double> column;
    for (const auto& row : features) column.push_back(row[k]);
    return column;
  }
};

/// How well one feature tells the classes apart, whichever way: 0.5 to 1.
[[nodiscard]] inline double AreaOfFeature(const TwoSamples& samples, std::size_t k) {
  const double area = AreaUnderCurve(samples.Column(k), samples.is_second);
  return std::max(area, 1.0 - area);
}

/// The area that a logistic regression on the features, their squares and products reaches on
/// samples which it has not seen: each part is scored by what the others have taught, and the areas
/// of the parts are averaged. Ridge of 1 on standardised features.
[[nodiscard]] inline double CrossValidatedArea(const TwoSamples& samples) {
  const std::size_t num_parts = 1 + *std::ranges::max_element(samples.part);
  const auto num = static_cast<Eigen::Index>(samples.features.size());
  const auto num_plain = static_cast<Eigen::Index>(samples.features.at(0).size());
  Eigen::MatrixXd plain(num, num_plain);
  Eigen::VectorXd target(num);
  for (Eigen::Index i = 0; i < num; ++i) {
    target[i] = samples.is_second[static_cast<std::size_t>(i)] ? 1.0 : 0.0;
    for (Eigen::Index k = 0; k < num_plain; ++k) {
      plain(i, k) = samples.features[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
    }
  }
  const auto standardise = [](Eigen::MatrixXd& values) {
    for (auto column : values.colwise()) {
      column.array() -= column.mean();
      column /=
          std::max(1e-12, std::sqrt(column.squaredNorm() / static_cast<double>(values.rows())));
    }
  };
  standardise(plain);
  Eigen::MatrixXd inputs(num, num_plain + num_plain * (num_plain + 1) / 2);
  inputs.leftCols(num_plain) = plain;
  Eigen::Index next = num_plain;
  for (Eigen::Index a = 0; a < num_plain; ++a) {
    for (Eigen::Index b = a; b < num_plain; ++b) {
      inputs.col(next++) = plain.col(a).cwiseProduct(plain.col(b));
    }
  }
  standardise(inputs);
  inputs.conservativeResize(Eigen::NoChange, inputs.cols() + 1);
  inputs.rightCols(1).setOnes();
  double sum = 0.0;
  for (std::size_t fold = 0; fold < num_parts; ++fold) {
    Eigen::VectorXd is_taught(num);
    for (Eigen::Index i = 0; i < num; ++i) {
      is_taught[i] = samples.part[static_cast<std::size_t>(i)] == fold ? 0.0 : 1.0;
    }
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(inputs.cols());
    for (int step = 0; step < 12; ++step) {  // Newton's method.
      const Eigen::VectorXd guess =
          (1.0 + (-(inputs * weights).array().cwiseMax(-30.0).cwiseMin(30.0)).exp()).inverse();
      const Eigen::VectorXd curvature =
          (guess.array() * (1.0 - guess.array()) * is_taught.array()).matrix();
      Eigen::MatrixXd hessian = inputs.transpose() * curvature.asDiagonal() * inputs;
      hessian.diagonal().array() += 1.0;
      const Eigen::VectorXd error = ((target - guess).array() * is_taught.array()).matrix();
      weights += hessian.ldlt().solve(inputs.transpose() * error - weights);
    }
    const Eigen::VectorXd all_scores = inputs * weights;
    std::vector<double> scores;
    std::vector<bool> is_second;
    for (Eigen::Index i = 0; i < num; ++i) {
      if (is_taught[i] != 0.0) continue;
      scores.push_back(all_scores[i]);
      is_second.push_back(target[i] != 0.0);
    }
    sum += AreaUnderCurve(scores, is_second);
  }
  return sum / static_cast<double>(num_parts);
}

}  // namespace railcast
