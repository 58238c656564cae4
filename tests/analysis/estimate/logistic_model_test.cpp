#include "analysis/estimate/logistic_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace railcast {
namespace {

// One group of each kind: the penalised estimate of a saturated table adds a half to each cell.
TEST(LogisticModel, OfTwoGroupsIsTheirLogOddsWithAHalfAddedToEachCount) {
  Eigen::MatrixXd x(30, 2);
  Eigen::VectorXd y(30);
  for (int i = 0; i < 30; ++i) {
    x(i, 0) = 1.0;
    x(i, 1) = i < 10 ? 0.0 : 1.0;
    y[i] = (i < 10 ? i < 3 : i < 25) ? 1.0 : 0.0;
  }
  const LogisticModel model = FitLogistic(x, y, {true, true});
  const double first = std::log(3.5 / 7.5);
  const double second = std::log(15.5 / 5.5);
  EXPECT_NEAR(model.coefficients[0], first, 1e-6);
  EXPECT_NEAR(model.coefficients[1], second - first, 1e-6);
}

TEST(LogisticModel, StaysFiniteWhereAColumnSeparatesTheOutcomes) {
  Eigen::MatrixXd x(20, 2);
  Eigen::VectorXd y(20);
  for (int i = 0; i < 20; ++i) {
    x(i, 0) = 1.0;
    x(i, 1) = i < 10 ? -1.0 : 1.0;
    y[i] = i < 10 ? 0.0 : 1.0;
  }
  const LogisticModel model = FitLogistic(x, y, {true, true});
  EXPECT_NEAR(model.coefficients[1], std::log(10.5 / 0.5), 1e-6);
}

TEST(LogisticModel, KeepsWhatIsNotFreeAtZero) {
  Eigen::MatrixXd x(8, 2);
  Eigen::VectorXd y(8);
  for (int i = 0; i < 8; ++i) {
    x(i, 0) = 1.0;
    x(i, 1) = i % 2 == 0 ? -1.0 : 1.0;
    y[i] = i < 6 ? 1.0 : 0.0;
  }
  const LogisticModel some = FitLogistic(x, y, {true, false});
  EXPECT_EQ(some.coefficients[1], 0.0);
  EXPECT_LE(some.log_likelihood, FitLogistic(x, y, {true, true}).log_likelihood + 1e-9);
}

TEST(LogisticModel, LeavesOutColumnsThatFollowFromOthers) {
  Eigen::MatrixXd x(4, 4);
  x << 1, 0, 1, 3,  //
      1, 1, 0, 1,   //
      1, 0, 1, 4,   //
      1, 1, 0, 1;
  EXPECT_EQ(IndependentColumns(x), (std::vector<std::size_t>{0, 1, 3}));
}

}  // namespace
}  // namespace railcast
