#include "core/program/command_line.h"

#include <gtest/gtest.h>

namespace railcast {
namespace {

TEST(ParseWholeNumber, TakesDecimalDigitsAloneAndLeadingZerosForNothing) {
  EXPECT_EQ(ParseWholeNumber("0"), 0U);
  EXPECT_EQ(ParseWholeNumber("30"), 30U);
  EXPECT_EQ(ParseWholeNumber("000030"), 30U);
  EXPECT_EQ(ParseWholeNumber("000008"), 8U);
  EXPECT_EQ(ParseWholeNumber("18446744073709551615"), 18446744073709551615U);
  EXPECT_EQ(ParseWholeNumber("0000000000000000000000000000001"), 1U);
}

TEST(ParseWholeNumber, GivesNothingForAnythingElse) {
  for (const char* text : {"", "-1", "+1", " 1", "1 ", "0x10", "1e3", "1.0", "1'000", "ten",
                           "18446744073709551616", "99999999999999999999999"}) {
    EXPECT_FALSE(ParseWholeNumber(text)) << text;
  }
}

TEST(WholeNumberRule, LeavesPlainDigits) {
  std::string text = "000030";
  EXPECT_EQ(WholeNumberRule({0, 30})(text), "");
  EXPECT_EQ(text, "30");
}

TEST(WholeNumberRule, NamesItsRangeAndTheText) {
  for (const char* outside : {"0", "65536", "0x10", "-1"}) {
    std::string text = outside;
    EXPECT_EQ(WholeNumberRule({1, 65535})(text),
              std::string("must be a whole number from 1 to 65535 (got ") + outside + ")");
    EXPECT_EQ(text, outside);
  }
}

TEST(NumberRule, TakesDecimalNumbersWithinItsRange) {
  for (std::string text : {"0.5", "1e1", "-0", "5", "010"}) {
    EXPECT_EQ(NumberRule({0.0, 10.0})(text), "") << text;
  }
  for (std::string text : {"nan", "inf", "-1", "10.1", "0x1", "1e400", "", " 1", "1 ", "two"}) {
    EXPECT_EQ(NumberRule({0.0, 10.0})(text), "must be a number from 0 to 10 (got " + text + ")");
  }
}

TEST(NonEmptyRule, IsBrokenByTheEmptyTextAlone) {
  EXPECT_EQ(NonEmptyRule(""), "must not be empty");
  EXPECT_EQ(NonEmptyRule(" "), "");
}

}  // namespace
}  // namespace railcast
