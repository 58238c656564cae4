#include <gtest/gtest.h>

#include "core/extras/recipe/json_place.h"
#include "core/extras/recipe/recipe.h"
#include "railcast/error.h"
#include "tests/core/scenario/malformed_case.h"

namespace railcast {
namespace {

class MalformedRecipe : public testing::TestWithParam<MalformedCase> {};

TEST_P(MalformedRecipe, GivesExactlyTheExpectedLines) {
  std::filesystem::current_path(ScenariosDir());
  try {
    static_cast<void>(ReadRecipe(GetParam().file));
    FAIL() << "expected InputError:\n" << GetParam().expected;
  } catch (const InputError& error) {
    EXPECT_EQ(error.what() + std::string("\n"), GetParam().expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenarios,
                         MalformedRecipe,
                         testing::ValuesIn(MalformedCases("recipes")),
                         [](const auto& test) { return NameOf(test.param); });

class ShippedRecipe : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(ShippedRecipe, IsSound) {
  EXPECT_NO_THROW(static_cast<void>(ReadRecipe(GetParam())));
}

INSTANTIATE_TEST_SUITE_P(Scenarios,
                         ShippedRecipe,
                         testing::ValuesIn(JsonFilesIn(ScenariosDir() / "recipes")),
                         [](const auto& test) { return test.param.stem().string(); });

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
