#include <gtest/gtest.h>

#include "core/base/error.h"
#include "railcast/scenario.h"
#include "tests/core/scenario/malformed_case.h"

namespace railcast {
namespace {

class MalformedFile : public testing::TestWithParam<MalformedCase> {};

TEST_P(MalformedFile, GivesExactlyTheExpectedLines) {
  std::filesystem::current_path(ScenariosDir());
  try {
    static_cast<void>(ReadScenario(GetParam().file));
    FAIL() << "expected InputError:\n" << GetParam().expected;
  } catch (const InputError& error) {
    EXPECT_EQ(error.what() + std::string("\n"), GetParam().expected);
  }
}

// Nothing that reads it may recurse as deep as it is nested.
TEST(DeepScenario, Of200000LevelsIsRefused) {
  const TemporaryFolder folder;
  constexpr std::size_t kLevels = 200'000;
  const std::string lists = std::string(kLevels, '[') + std::string(kLevels, ']');
  std::string objects;
  for (std::size_t i = 0; i < kLevels; ++i) objects += "{\"world\":";
  for (const std::string& text :
       {"{\"version\": 1, \"world\": " + lists + "}", objects + "1" + std::string(kLevels, '}')}) {
    const auto file = folder.Write("deep.json", text);
    EXPECT_EQ(CheckScenario(file),
              std::vector<std::string>{file.string() + ": nested deeper than 64 levels"});
  }
}

INSTANTIATE_TEST_SUITE_P(Scenarios,
                         MalformedFile,
                         testing::ValuesIn(MalformedCases("read")),
                         [](const auto& test) { return NameOf(test.param); });

}  // namespace
}  // namespace railcast
