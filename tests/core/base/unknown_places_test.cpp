#include "core/base/unknown_places.h"

#include <gtest/gtest.h>

namespace railcast {
namespace {

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
