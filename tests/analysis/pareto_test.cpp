#include "analysis/frontier/pareto.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/made_results.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

const FrontierError& Missed() {
  return kFrontierErrors.front();
}

TEST(ParetoFront, HoldsWhatNothingElseBeats) {
  const std::vector<RowResult> results = {MadeResult("raw_trace", RowGroup::kRawTrace, 1.0, 0),
                                          MadeResult("a", RowGroup::kLadder, 1.1, 30),
                                          MadeResult("b", RowGroup::kLadder, 2.0, 40),
                                          MadeResult("c", RowGroup::kBruteForce, 3.0, 20),
                                          MadeResult("d", RowGroup::kBetween, 3.0, 10),
                                          MadeResult("e", RowGroup::kReference, 2.5, 0)};
  EXPECT_THAT(ParetoFront(results, Missed()), ElementsAre("a", "d"));
}

TEST(ParetoFront, HoldsBothOfTwoEquals) {
  const std::vector<RowResult> results = {MadeResult("a", RowGroup::kLadder, 2.0, 30),
                                          MadeResult("b", RowGroup::kLadder, 2.0, 30)};
  EXPECT_THAT(ParetoFront(results, Missed()), ElementsAre("a", "b"));
}

TEST(ParetoFront, LeavesOutWhatHasNoSuchError) {
  const auto intensity = std::find_if(
      kFrontierErrors.begin(), kFrontierErrors.end(),
      [](const FrontierError& error) { return std::string(error.name) == "intensity_median"; });
  EXPECT_THAT(ParetoFront({MadeResult("a", RowGroup::kLadder, 1.0, 0)}, *intensity), IsEmpty());
}

TEST(FindDefeats, NamesBruteForceThatIsFasterAndMoreAccurate) {
  const std::vector<RowResult> results = {MadeResult("surface", RowGroup::kLadder, 2.0, 30),
                                          MadeResult("footprint", RowGroup::kLadder, 5.0, 10),
                                          MadeResult("between", RowGroup::kBetween, 9.0, 90),
                                          MadeResult("brute_4", RowGroup::kBruteForce, 4.0, 9)};
  const std::vector<Defeat> defeats = FindDefeats(results);
  ASSERT_FALSE(defeats.empty());
  EXPECT_EQ(defeats[0].brute_force, "brute_4");
  EXPECT_EQ(defeats[0].ours, "footprint");
  EXPECT_EQ(defeats[0].error, "missed_share");
  EXPECT_THAT(DefeatsText(results),
              StartsWith("Faster and more accurate than a rung: brute_4 than footprint in "
                         "missed_share"));
}

TEST(FindDefeats, FindsNoneWhereBruteForceIsSlowerOrWorse) {
  const std::vector<RowResult> results = {MadeResult("footprint", RowGroup::kLadder, 3.0, 10),
                                          MadeResult("brute_4", RowGroup::kBruteForce, 2.0, 20),
                                          MadeResult("brute_64", RowGroup::kBruteForce, 20.0, 2)};
  std::vector<Defeat> missed = FindDefeats(results);
  std::erase_if(missed, [](const Defeat& defeat) { return defeat.error != "missed_share"; });
  EXPECT_THAT(missed, IsEmpty());
  const std::vector<RowResult> alike = {MadeResult("footprint", RowGroup::kLadder, 3.0, 10),
                                        MadeResult("brute_4", RowGroup::kBruteForce, 3.0, 10)};
  EXPECT_EQ(DefeatsText(alike), "No row of brute force is faster and more accurate than a rung.");
}

TEST(FindDefeats, ClaimNothingWithoutRowsOfBothKinds) {
  const std::string none =
      "Brute force is not compared with the rungs: there must be rows of both.";
  EXPECT_EQ(DefeatsText({}), none);
  EXPECT_EQ(DefeatsText({MadeResult("footprint", RowGroup::kLadder, 3.0, 10),
                         MadeResult("d", RowGroup::kBetween, 3.0, 10)}),
            none);
  EXPECT_EQ(DefeatsText({MadeResult("brute_4", RowGroup::kBruteForce, 2.0, 20)}), none);
}

}  // namespace
}  // namespace railcast
