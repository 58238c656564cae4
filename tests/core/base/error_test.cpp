#include "core/base/error.h"

#include <gtest/gtest.h>

#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

TEST(ErrorList, ThrowsEveryLineAtOnce) {
  ErrorList errors;
  EXPECT_NO_THROW(errors.ThrowIfAny());
  errors.Add({"a.json: /x", "must be > 0", "-1"});
  errors.Add({"a.json: /y", "missing", ""});
  EXPECT_EQ(MessageOf([&] { errors.ThrowIfAny(); }),
            "a.json: /x: must be > 0 (got -1)\na.json: /y: missing");
}

TEST(ErrorList, KeepsEachLineOnce) {
  ErrorList errors;
  for (const char* line : {"a", "b", "a"}) errors.AddLine(line);
  EXPECT_EQ(errors.lines(), (std::vector<std::string>{"a", "b"}));
}

TEST(CheckDeathTest, NamesPlaceAndAssumption) {
  EXPECT_DEATH(Check(false, "sum is one"), "error_test.cpp:[0-9]+: broken assumption: sum is one");
}

TEST(InputError, ShowsTheFirstTwentyFaultsAndHowManyThereAreMore) {
  ErrorList errors;
  for (int i = 0; i < 200'000; ++i)
    errors.Add({"a.json: /" + std::to_string(i), "unknown key", ""});
  std::string twenty;
  for (int i = 0; i < 20; ++i) twenty += "a.json: /" + std::to_string(i) + ": unknown key\n";
  try {
    errors.ThrowIfAny();
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), twenty + "... and 199980 more faults");
    EXPECT_EQ(error.faults().size(), 200'000U);
  }
  twenty.pop_back();
  EXPECT_EQ(InputError(twenty).what(), twenty);
  EXPECT_EQ(InputError(twenty + "\nb\nc").what(), twenty + "\n... and 2 more faults");
}

TEST(UnknownPlaces, KnowEverythingWhereNothingIsFaulty) {
  EXPECT_TRUE(UnknownPlaces().IsKnown(""));
  EXPECT_TRUE(UnknownPlaces().IsKnown("/world/tracks/0"));
}

TEST(UnknownPlaces, ReachUpAndDownFromAFaultButNotAside) {
  UnknownPlaces unknown;
  unknown.Add("/world/objects/1");
  EXPECT_FALSE(unknown.IsKnown(""));
  EXPECT_FALSE(unknown.IsKnown("/world"));
  EXPECT_FALSE(unknown.IsKnown("/world/objects/1"));
  EXPECT_FALSE(unknown.IsKnown("/world/objects/1/s_m"));
  EXPECT_TRUE(unknown.IsKnown("/world/objects/0"));
  EXPECT_TRUE(unknown.IsKnown("/world/tracks"));
}

TEST(UnknownPlaces, DoNotMistakeAKeyForOneThatItBeginsWith) {
  UnknownPlaces unknown;
  unknown.Add("/world/objects/10");
  unknown.Add("/world/track-gauge");
  EXPECT_TRUE(unknown.IsKnown("/world/objects/1"));
  EXPECT_TRUE(unknown.IsKnown("/world/track"));
}

TEST(UnknownPlaces, HoldEverythingWhereTheWholeIsFaulty) {
  UnknownPlaces unknown;
  unknown.Add("");
  EXPECT_FALSE(unknown.IsKnown("/seed"));
}

}  // namespace

}  // namespace railcast
