#include <gtest/gtest.h>

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

}  // namespace
}  // namespace railcast
