#include "core/extras/recipe/json_place.h"

#include <gtest/gtest.h>

namespace railcast {
namespace {

TEST(JsonPlace, SetsMembersAndElementsAndMakesObjectsOnTheWay) {
  Json root = Json::parse(R"({"a": {"b": [1, 2]}})");
  EXPECT_EQ(SetAt(root, "/a/b/1", 5), std::nullopt);
  EXPECT_EQ(SetAt(root, "/c/d~1e/f~0g", "x"), std::nullopt);
  EXPECT_EQ(root, Json::parse(R"({"a": {"b": [1, 5]}, "c": {"d/e": {"f~g": "x"}}})"));
}

TEST(JsonPlace, SaysWhatStandsInTheWay) {
  Json root = Json::parse(R"({"a": {"b": [1, 2]}, "c": 3})");
  EXPECT_EQ(SetAt(root, "/a/b/2", 5), "/a/b has no element 2");
  EXPECT_EQ(SetAt(root, "/a/b/01x", 5), "/a/b has no element 01x");
  EXPECT_EQ(SetAt(root, "/c/d", 5), "/c is neither an object nor a list");
}

TEST(JsonPlace, ReplacesTheKeyThatExcludesTheOneSet) {
  Json root = Json::parse(R"({"weather": {"fog_density_per_m": 0.0, "rain_rate_mmph": 1}})");
  EXPECT_EQ(SetAt(root, "/weather/visibility_m", 100), std::nullopt);
  EXPECT_EQ(root, Json::parse(R"({"weather": {"rain_rate_mmph": 1, "visibility_m": 100}})"));
}

TEST(JsonPlace, KnowsPointers) {
  EXPECT_EQ(PointerFault("/a/b~0~1/0"), std::nullopt);
  EXPECT_NE(PointerFault("a"), std::nullopt);
  EXPECT_NE(PointerFault("/a~"), std::nullopt);
  EXPECT_NE(PointerFault("/a~2"), std::nullopt);
  EXPECT_TRUE(LiesWithin("/a/b", "/a"));
  EXPECT_TRUE(LiesWithin("/a", "/a"));
  EXPECT_FALSE(LiesWithin("/ab", "/a"));
}

}  // namespace
}  // namespace railcast
