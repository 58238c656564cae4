#include <Eigen/Cholesky>
#include <algorithm>
#include <map>

#include "core/track/track_search.h"

namespace railcast {

bool ClusteredFit::Solve() {
  constexpr double kTypical_m = 0.02;
  constexpr std::size_t kFewest = 8;
  if (rows_.size() < kFewest) return false;
  Square normal = Square::Zero();
  Row right = Row::Zero();
  for (const Sample& sample : rows_) {
    normal += sample.weight * sample.row * sample.row.transpose();
    right += sample.weight * sample.value * sample.row;
  }
  // Residuals are some centimetres: a prior counts as much as a point at its deviation.
  normal.diagonal() += kTypical_m * kTypical_m * information_;
  const Eigen::LDLT<Square> solver(normal);
  solution = solver.solve(right);
  std::map<int, Row> clusters;
  for (const Sample& sample : rows_) {
    Row& sum = clusters.try_emplace(sample.cluster, Row::Zero()).first->second;
    sum += sample.weight * (sample.value - sample.row.dot(solution)) * sample.row;
  }
  Square spread = Square::Zero();
  for (const auto& [cluster, sum] : clusters) spread += sum * sum.transpose();
  const auto num = static_cast<double>(clusters.size());
  const Square inverse = solver.solve(Square::Identity());
  covariance = num / std::max(1.0, num - 4.0) * inverse * spread * inverse;
  covariance += kTypical_m * kTypical_m * inverse * information_.asDiagonal() * inverse *
                kTypical_m * kTypical_m;
  return true;
}

}  // namespace railcast
