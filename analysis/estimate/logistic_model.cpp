#include "analysis/estimate/logistic_model.h"

#include <Eigen/Cholesky>
#include <utility>

#include "core/base/error.h"

namespace railcast {
namespace {

/// The likelihood at some coefficients and what Newton's method needs there.
struct LogisticPoint {
  double log_likelihood{};
  Eigen::VectorXd score;
  Eigen::MatrixXd information;
};

LogisticPoint EvaluateLogistic(const Eigen::MatrixXd& x,
                               const Eigen::VectorXd& y,
                               const Eigen::VectorXd& coefficients) {
  const Eigen::ArrayXd linear = (x * coefficients).array();
  const Eigen::ArrayXd probability = 1.0 / (1.0 + (-linear).exp());
  // Far out, rounding must not make the information singular.
  const Eigen::ArrayXd weight = (probability * (1.0 - probability)).max(1e-12);
  LogisticPoint point;
  point.information = x.transpose() * weight.matrix().asDiagonal() * x;
  const Eigen::LLT<Eigen::MatrixXd> factor(point.information);
  const Eigen::MatrixXd solved = factor.solve(x.transpose());
  const Eigen::ArrayXd leverage = weight * (x.array() * solved.transpose().array()).rowwise().sum();
  point.score = x.transpose() * (y.array() - probability + leverage * (0.5 - probability)).matrix();
  const Eigen::ArrayXd signed_linear = (2.0 * y.array() - 1.0) * linear;
  // log(1 / (1 + exp(-z))), for large |z| too.
  const Eigen::ArrayXd log_probability =
      signed_linear.min(0.0) - (1.0 + (-signed_linear.abs()).exp()).log();
  const Eigen::MatrixXd lower = factor.matrixL();
  point.log_likelihood = log_probability.sum() + lower.diagonal().array().log().sum();
  return point;
}

}  // namespace

LogisticModel FitLogistic(const Eigen::MatrixXd& x,
                          const Eigen::VectorXd& y,
                          const std::vector<bool>& is_free) {
  constexpr int kMostSteps = 200;
  constexpr int kMostHalvings = 30;
  constexpr double kAccuracy = 1e-9;
  Check(x.rows() == y.size() && static_cast<std::size_t>(x.cols()) == is_free.size(),
        "a row for each outcome and a column for each coefficient");
  std::vector<Eigen::Index> free;
  for (std::size_t i = 0; i < is_free.size(); ++i) {
    if (is_free[i]) free.push_back(static_cast<Eigen::Index>(i));
  }
  LogisticModel model{Eigen::VectorXd::Zero(x.cols()), 0.0};
  LogisticPoint point = EvaluateLogistic(x, y, model.coefficients);
  for (int step = 0; step < kMostSteps && !free.empty(); ++step) {
    const Eigen::VectorXd change =
        point.information(free, free).eval().ldlt().solve(point.score(free).eval());
    // Steps that are too long for the quadratic approximation are halved.
    double share = 1.0;
    Eigen::VectorXd next;
    LogisticPoint at_next;
    for (int i = 0; i < kMostHalvings; ++i, share *= 0.5) {
      next = model.coefficients;
      next(free) += share * change;
      at_next = EvaluateLogistic(x, y, next);
      if (at_next.log_likelihood >= point.log_likelihood) break;
    }
    if (!(at_next.log_likelihood >= point.log_likelihood)) break;
    const double gain = at_next.log_likelihood - point.log_likelihood;
    model.coefficients = std::move(next);
    point = std::move(at_next);
    if (gain < kAccuracy) break;
  }
  model.log_likelihood = point.log_likelihood;
  return model;
}

std::vector<std::size_t> IndependentColumns(const Eigen::MatrixXd& x) {
  constexpr double kLeastRest = 1e-6;
  std::vector<std::size_t> independent;
  Eigen::MatrixXd basis(x.rows(), 0);
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    // Twice, since what is subtracted first is rounded.
    Eigen::VectorXd rest = x.col(i);
    for (int turn = 0; turn < 2; ++turn) rest -= basis * (basis.transpose() * rest);
    if (!(rest.norm() > kLeastRest * x.col(i).norm())) continue;
    independent.push_back(static_cast<std::size_t>(i));
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.rightCols(1) = rest.normalized();
  }
  return independent;
}

}  // namespace railcast
