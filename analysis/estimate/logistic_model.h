#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace railcast {

/// A logistic regression: P(y = 1) = 1 / (1 + exp(-x b)).
struct LogisticModel {
  Eigen::VectorXd coefficients;  ///< b; 0 where they are not free.
  double log_likelihood{};       ///< Penalised.
};

/// Fits the coefficients by maximum likelihood, penalised by half the logarithm of the determinant
/// of Fisher's information (Firth 1993, Biometrika 80), which keeps them finite where a column
/// separates the outcomes (Heinze and Schemper 2002, Statistics in Medicine 21).
///
/// Twice the difference of the log-likelihoods of all coefficients and of some of them is about
/// chi-squared with as many degrees of freedom as the others, if those are 0.
/// @param x One row for each outcome, of full column rank, with a column of ones for the intercept.
/// @param y 0 or 1.
/// @param is_free For each column, whether its coefficient is estimated; otherwise it is 0.
[[nodiscard]] LogisticModel FitLogistic(const Eigen::MatrixXd& x,
                                        const Eigen::VectorXd& y,
                                        const std::vector<bool>& is_free);

/// Indices of the columns that are not linear combinations of those before them.
[[nodiscard]] std::vector<std::size_t> IndependentColumns(const Eigen::MatrixXd& x);

}  // namespace railcast
