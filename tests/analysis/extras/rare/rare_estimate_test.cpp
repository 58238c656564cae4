#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "analysis/extras/rare/rare_event.h"

namespace railcast {
namespace {

/// Trials of which those before `num_failed` fail on the cheap level.
WeightedTrials Trials(std::size_t num, std::size_t num_failed, double weight) {
  WeightedTrials trials{.weights = std::vector<double>(num, weight),
                        .scores = std::vector<RareScores>(num, RareScores{1.0}),
                        .own_weights = std::vector<double>(num, weight)};
  for (std::size_t i = 0; i < num_failed; ++i) trials.scores[i].cheap = -1.0;
  return trials;
}

TEST(RareEstimate, KnowsNoProbabilityAboveOne) {
  const WeightedTrials trials = Trials(200, 199, 1.001);
  const RareFigure figure = EstimateRareFigure({.cheap = {trials, trials}});
  ASSERT_TRUE(figure.is_known()) << figure.refusal;
  EXPECT_LE(figure.probability.high, 1.0);
  EXPECT_GE(PlainTrialsFor(figure.probability), 0.0);
}

TEST(RareEstimate, KnowsWhereAllTrialsAreEqual) {
  const WeightedTrials trials = Trials(100, 100, 0.5);
  const RareFigure figure = EstimateRareFigure({.cheap = {trials, trials}});
  ASSERT_TRUE(figure.is_known()) << figure.refusal;
  EXPECT_NEAR(figure.probability.low, 0.5, 1e-4);
  EXPECT_NEAR(figure.probability.value, 0.5, 1e-12);
  // One more of 200, with its own error.
  EXPECT_NEAR(figure.probability.high, 0.5025 + 1.96 * 0.0025, 1e-4);
}

TEST(RareEstimate, HasAnUpperEndWhereTheLevelsNearlyCancel) {
  const WeightedTrials cheap = Trials(3000, 1500, 0.02);
  RareEvidence evidence{.cheap = {cheap, cheap}, .pairs = {Trials(3000, 1499, 0.02)}};
  for (RareScores& scores : evidence.pairs[0].scores) scores.dear = 1.0;
  const RareFigure figure = EstimateRareFigure(evidence);
  ASSERT_TRUE(figure.is_known()) << figure.refusal;
  EXPECT_NEAR(figure.probability.value, 0.02 * 1.0 / 3000.0, 1e-9);
  // The variance of a trial is that of a share of a half, on both levels.
  const double error = 0.02 * 0.5 * std::sqrt(1.0 / 6000.0 + 1.0 / 3000.0);
  EXPECT_NEAR(figure.probability.high, figure.probability.value + 1.96 * error, 0.02 * error);
}

/// A met part of twelve failures, 0.001 in all, and so many others of 3000 trials by p.
RareEvidence TwelveMetAnd(std::size_t num_beyond) {
  RareEvidence evidence{.cheap = {Trials(1500, 6, 0.25), Trials(1500, 6, 0.25)}};
  evidence.own.scores = Trials(3000, num_beyond, 1.0).scores;
  evidence.own.cheap_weights = std::vector<double>(3000, 2.0);
  return evidence;
}

TEST(RareEstimate, NeedsSoundSearchesOnlyWhereTheyMeetMostOfIt) {
  for (const std::size_t num_beyond : {0U, 1U, 2U}) {
    const RareFigure figure = EstimateRareFigure(TwelveMetAnd(num_beyond));
    EXPECT_EQ(figure.refusal, "only 12 trials are effective, and 100 are needed") << num_beyond;
  }
  for (const std::size_t num_beyond : {4U, 40U, 2990U}) {
    const RareFigure figure = EstimateRareFigure(TwelveMetAnd(num_beyond));
    ASSERT_TRUE(figure.is_known()) << figure.refusal;
    const double beyond = static_cast<double>(num_beyond) / 3000.0;
    EXPECT_NEAR(figure.probability.value, 0.001 + beyond, 1e-12);
    EXPECT_LT(figure.probability.low, 0.001 + beyond);
    EXPECT_GT(figure.probability.high, 0.001 + beyond);
  }
}

TEST(RareEstimate, IsTheShareByTheirOwnLawWhereProposalsMeetNothing) {
  for (const std::size_t num_failed : {1U, 180U, 3000U}) {
    RareEvidence evidence = TwelveMetAnd(num_failed);
    evidence.cheap = {Trials(600, 36, 0.9), Trials(600, 36, 0.9)};
    const RareFigure figure = EstimateRareFigure(evidence);
    ASSERT_TRUE(figure.is_known()) << figure.refusal;
    EXPECT_EQ(figure.met.value, 0.0);
    EXPECT_EQ(figure.probability.value, figure.beyond.share.value);
    EXPECT_NEAR(figure.probability.low, figure.beyond.share.low, 1e-12);
    EXPECT_NEAR(figure.probability.high, figure.beyond.share.high, 1e-12);
  }
}

TEST(RareEstimate, TakesWeightsWhoseSquaresAreTooSmall) {
  for (const std::size_t num_beyond : {0U, 4U}) {
    RareEvidence evidence = TwelveMetAnd(num_beyond);
    evidence.cheap = {Trials(1500, 600, 1e-200), Trials(1500, 600, 1e-200)};
    const RareFigure figure = EstimateRareFigure(evidence);
    EXPECT_EQ(figure.is_known(), num_beyond > 0) << figure.refusal;
  }
}

TEST(RareEstimate, RefusesWhatIsNotKnownOnTheDearLevel) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  RareEvidence evidence{.cheap = {Trials(200, 100, 0.1), Trials(200, 100, 0.1)},
                        .pairs = {Trials(200, 100, 0.1)}};
  std::vector<RareScores>& pairs = evidence.pairs[0].scores;
  for (RareScores& scores : pairs) scores.dear = scores.cheap;
  EXPECT_TRUE(EstimateRareFigure(evidence).is_known());
  for (std::size_t i = 0; i < 20; ++i) pairs[i].dear = kUnknown;
  EXPECT_THAT(EstimateRareFigure(evidence).refusal,
              testing::StartsWith("too many trials say neither yes nor no"));
  // What the cheap level does not know is of no matter where the dear one does.
  for (RareScores& scores : pairs) scores.dear = scores.cheap;
  for (std::size_t i = 0; i < 20; ++i) evidence.cheap[0].scores[199 - i].cheap = kUnknown;
  EXPECT_TRUE(EstimateRareFigure(evidence).is_known());
}

TEST(RareEstimate, HasNoBoundWhereNothingIsKnown) {
  WeightedTrials trials = Trials(200, 0, 1.0);
  for (RareScores& scores : trials.scores) scores.cheap = std::nan("");
  const RareFigure figure = EstimateRareFigure({.cheap = {trials, trials}});
  EXPECT_THAT(figure.refusal, testing::StartsWith("too many trials say neither yes nor no"));
  EXPECT_TRUE(std::isnan(figure.at_most));
}

}  // namespace
}  // namespace railcast
