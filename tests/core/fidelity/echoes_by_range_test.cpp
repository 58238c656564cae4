#include "core/fidelity/echoes_by_range.h"

#include <gtest/gtest.h>

#include <cmath>

namespace railcast {
namespace {

using Sums = EchoesByRange::Sums;

TEST(EchoesByRange, TellsTheNearestEchoOfAFiringFromItsOthers) {
  Frame frame;
  frame.Resize(1, 2, 2);
  frame.label = {7, 7, 7, 8};
  frame.true_range_m = {40.0F, 35.0F, 10.0F, 20.0F};
  frame.intensity = {0.1F, 0.2F, 0.5F, 0.9F};
  frame.outcome = {Outcome::kReturned, Outcome::kReturned, Outcome::kBelowThreshold,
                   Outcome::kReturned};
  EchoesByRange echoes(30.0);
  echoes.AddFrame(frame);
  echoes.AddFrame(frame);
  ASSERT_EQ(echoes.Of(7, 1).size(), 2U);
  EXPECT_EQ(echoes.Of(7, 1)[0].first, 1.0);
  EXPECT_EQ(echoes.Of(7, 1)[0].further, 1.0);
  EXPECT_NEAR(echoes.Of(7, 1)[1].intensity, 0.2, 1e-6);
  EXPECT_TRUE(echoes.Of(7, 0).empty());
  EXPECT_EQ(echoes.Of(8, 0)[1].first, 1.0);
  EXPECT_EQ(echoes.Places(), (std::vector<EchoesByRange::Place>{{7, 1}, {8, 0}}));
}

TEST(EchoesByRange, CountsNeighboursOnTheSameLabel) {
  Frame frame;
  frame.Resize(2, 3, 1);
  frame.label = {7, 7, 8, 7, 7, 7};
  frame.true_range_m = {10.0F, 10.05F, 10.0F, 10.0F, 11.0F, 11.0F};
  frame.outcome.assign(6, Outcome::kReturned);
  EchoesByRange echoes(30.0);
  echoes.AddFrame(frame);
  EXPECT_EQ(echoes.Of(7, 0)[0].neighbours, 3.0);
  EXPECT_EQ(echoes.Of(7, 0)[0].near_neighbours, 2.0);
  EXPECT_EQ(echoes.Of(8, 0)[0].neighbours, 0.0);
}

TEST(RelativeChange, HasAnIntervalFromTheFramesAgainstEachOther) {
  const std::vector<Sums> from = {{.first = 100, .intensity = 10}, {.first = 200, .intensity = 20}};
  const std::vector<Sums> doubled = {{.first = 200, .intensity = 40},
                                     {.first = 400, .intensity = 80}};
  EXPECT_DOUBLE_EQ(ChangeOfSum(from, doubled, &Sums::first).change, 1.0);
  EXPECT_NEAR(ChangeOfSum(from, doubled, &Sums::first).margin, 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(ChangeOfIntensity(from, doubled).change, 1.0);
  EXPECT_NEAR(ChangeOfIntensity(from, doubled).margin, 0.0, 1e-12);
  // Shares of the frames: 1/3 and 2/3 before, 2/3 and 1/3 after.
  const std::vector<Sums> swapped = {{.first = 200, .intensity = 20},
                                     {.first = 100, .intensity = 10}};
  EXPECT_DOUBLE_EQ(ChangeOfSum(from, swapped, &Sums::first).change, 0.0);
  EXPECT_NEAR(ChangeOfSum(from, swapped, &Sums::first).margin, 1.96 * std::sqrt(2.0 / 9.0), 1e-12);
}

TEST(RelativeChange, OfHeightsIsThatOfTheirStandardDeviation) {
  // Two heights a frame: 1 m above and below the mean of 3 m, then 2 m above and below that of 5 m.
  const std::vector<Sums> from(2, {.num_surveyed = 2, .height_m = 6, .square_height_m2 = 20});
  const std::vector<Sums> wider(2, {.num_surveyed = 2, .height_m = 10, .square_height_m2 = 58});
  EXPECT_NEAR(ChangeOfHeights(from, wider).change, 1.0, 1e-12);
  EXPECT_NEAR(ChangeOfHeights(from, wider).margin, 0.0, 1e-12);
}

}  // namespace
}  // namespace railcast
