#include "analysis/extras/rare/proposal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace railcast {
namespace {

const std::vector<RareFactor>& Factors() {
  static const std::vector<RareFactor> factors = {
      {.probabilities = {0.2, 0.8}}, {.only_with = RareFactor::Condition{0, 1}}, {}};
  return factors;
}

// A mode where the choice is 1 and the first number is great, and one where it is 0.
Proposal TwoModes() {
  WeightedPoints elite;
  for (std::uint32_t i = 0; i < 400; ++i) {
    RarePoint point = DrawPoint({.factors = Factors()}, 7, i);
    point[0] = i % 2;
    point[1] = 1.5 + 0.3 * point[1];
    if (i % 2 == 0) point[2] = -2.0 + 0.3 * point[2];
    elite.points.push_back(point);
    elite.weights.push_back(1.0);
  }
  return FitProposal(Factors(), elite, 3);
}

TEST(Proposal, HasWeightsOfTheMeanOne) {
  constexpr std::uint32_t kNum = 20'000;
  const Proposal proposal = TwoModes();
  ASSERT_GE(proposal.modes.size(), 2U);
  double sum = 0.0;
  double sum_of_number = 0.0;
  double most = 0.0;
  for (std::uint32_t i = 0; i < kNum; ++i) {
    const RarePoint point = DrawPoint(proposal, 5, i);
    const double weight = WeightOf(proposal, point);
    sum += weight / kNum;
    sum_of_number += weight * point[2] / kNum;
    most = std::max(most, weight);
  }
  // Weights are at most 10, so that a mean has an error of at most sqrt(10 / 20000) = 0.022.
  EXPECT_NEAR(sum, 1.0, 0.07);
  EXPECT_NEAR(sum_of_number, 0.0, 0.1);
  EXPECT_LE(most, 10.0 + 1e-9);
}

TEST(Proposal, GoesWhereThePointsAre) {
  const Proposal proposal = TwoModes();
  double num_inside = 0.0;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const RarePoint point = DrawPoint(proposal, 5, i);
    num_inside += point[0] == 1.0 ? (point[1] > 0.7 ? 1.0 : 0.0) : (point[2] < -1.2 ? 1.0 : 0.0);
  }
  // By p: 0.8 x 0.24 + 0.2 x 0.12 = 0.22.
  EXPECT_GT(num_inside / 2000, 0.75);
}

TEST(Proposal, LeavesNumbersThatDoNotMatterAsTheyAre) {
  WeightedPoints elite;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    elite.points.push_back(DrawPoint({.factors = std::vector<RareFactor>(1)}, 7, i));
    elite.weights.push_back(1.0);
  }
  const Proposal proposal = FitProposal(std::vector<RareFactor>(1), elite, 3);
  for (const double score : {-2.0, -0.7, 0.0, 0.7, 2.0}) {
    EXPECT_NEAR(WeightOf(proposal, {score}), 1.0, 0.3) << score;
  }
}

TEST(Proposal, CountsNoFactorThatChangesNothing) {
  const Proposal proposal = TwoModes();
  EXPECT_EQ(WeightOf(proposal, {0.0, 0.1, -2.0}), WeightOf(proposal, {0.0, 0.9, -2.0}));
  EXPECT_NE(WeightOf(proposal, {1.0, 0.1, -2.0}), WeightOf(proposal, {1.0, 0.9, -2.0}));
}

}  // namespace
}  // namespace railcast
