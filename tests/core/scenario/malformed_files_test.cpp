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

INSTANTIATE_TEST_SUITE_P(Scenarios,
                         MalformedFile,
                         testing::ValuesIn(MalformedCases("read")),
                         [](const auto& test) { return NameOf(test.param); });

}  // namespace
}  // namespace railcast
