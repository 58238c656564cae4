#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "railcast/scenario.h"
#include "tests/core/scenario/malformed_case.h"

namespace railcast {
namespace {

class MalformedSurvey : public testing::TestWithParam<MalformedCase> {};

TEST_P(MalformedSurvey, GivesExactlyTheExpectedLines) {
  std::filesystem::current_path(ScenariosDir());
  std::string lines;
  for (const std::string& line : CheckScenario(GetParam().file)) lines += line + '\n';
  EXPECT_EQ(lines, GetParam().expected);
}

INSTANTIATE_TEST_SUITE_P(Scenarios,
                         MalformedSurvey,
                         testing::ValuesIn(MalformedCases("survey")),
                         [](const auto& test) { return NameOf(test.param); });

}  // namespace
}  // namespace railcast
