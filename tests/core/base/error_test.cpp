#include "core/base/error.h"

#include <gtest/gtest.h>

namespace railcast {
namespace {

TEST(ErrorList, ThrowsEveryLineAtOnce) {
  ErrorList errors;
  EXPECT_NO_THROW(errors.ThrowIfAny());
  errors.Add({"a.json: /x", "must be > 0", "-1"});
  errors.Add({"a.json: /y", "missing", ""});
  try {
    errors.ThrowIfAny();
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "a.json: /x: must be > 0 (got -1)\na.json: /y: missing");
  }
}

TEST(ErrorList, KeepsEachLineOnce) {
  ErrorList errors;
  for (const char* line : {"a", "b", "a"}) errors.AddLine(line);
  EXPECT_EQ(errors.lines(), (std::vector<std::string>{"a", "b"}));
}

TEST(CheckDeathTest, NamesPlaceAndAssumption) {
  EXPECT_DEATH(Check(false, "sum is one"), "error_test.cpp:[0-9]+: broken assumption: sum is one");
}

}  // namespace
}  // namespace railcast
