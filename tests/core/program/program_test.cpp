#include "core/program/program.h"

#include <gtest/gtest.h>

#include <new>
#include <sstream>
#include <stdexcept>

#include "core/base/error.h"
#include "core/program/command_line.h"
#include "railcast/remark.h"

namespace railcast {
namespace {

struct Outcome {
  int status{};
  std::string said;
};

Outcome RunOf(const std::function<int()>& main) {
  std::ostringstream said;
  const int status = RunProgram("railcast-test", main, said);
  return {status, said.str()};
}

TEST(RunProgram, GivesTheStatusOfItsMain) {
  const Outcome run = RunOf([] { return kExitInterrupted; });
  EXPECT_EQ(run.status, kExitInterrupted);
  EXPECT_EQ(run.said, "");
}

TEST(RunProgram, SaysAnInputErrorAsItIs) {
  const Outcome run =
      RunOf([]() -> int { throw InputError("a.json: must be valid\nb.json: too"); });
  EXPECT_EQ(run.status, kExitFailure);
  EXPECT_EQ(run.said, "a.json: must be valid\nb.json: too\n");
}

TEST(RunProgram, PrintsEachRemarkOnceAndBeforeAnError) {
  const Outcome run = RunOf([]() -> int {
    // The source was read twice, first in part.
    for (const std::uint64_t number : {1U, 3U}) {
      RemarkLog log;
      log.Add({.kind = RemarkKind::kPacketsDamaged, .place = "a.pcap", .number = number});
    }
    throw InputError("a.json: must be valid");
  });
  EXPECT_EQ(run.said,
            "railcast-test: remark packets-damaged: 3 packets with a wrong checksum (the first in "
            "a.pcap)\na.json: must be valid\n");
}

TEST(RunProgram, SaysWhoseOtherErrorsAre) {
  const Outcome run = RunOf([]() -> int { throw std::runtime_error("no such window"); });
  EXPECT_EQ(run.status, kExitFailure);
  EXPECT_EQ(run.said, "railcast-test: no such window\n");
}

TEST(RunProgram, SaysInWordsThatAThreadCouldNotBeStarted) {
  const Outcome run = RunOf([]() -> int {
    throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
  });
  EXPECT_EQ(run.status, kExitFailure);
  EXPECT_EQ(run.said,
            "no further thread can be started; fewer threads or more memory are needed\n");
}

TEST(RunProgram, SaysInWordsThatMemoryRanOut) {
  const Outcome run = RunOf([]() -> int { throw std::bad_alloc(); });
  EXPECT_EQ(run.status, kExitFailure);
  EXPECT_EQ(run.said, "railcast-test: out of memory\n");
}

void EndsWhereNothingMayBeThrown(const std::function<void()>& fail) {
  static_cast<void>(RunOf([&]() noexcept -> int {
    fail();
    return kExitSuccess;
  }));
}

TEST(RunProgramDeathTest, EndsInOrderWhereMemoryRunsOutInADestructor) {
  EXPECT_EXIT(EndsWhereNothingMayBeThrown([] { throw std::bad_alloc(); }),
              testing::ExitedWithCode(kExitFailure), "^out of memory\n$");
}

TEST(RunProgramDeathTest, EndsInOrderWhereTbbCannotStartAThread) {
  EXPECT_EXIT(
      EndsWhereNothingMayBeThrown([] {
        throw std::runtime_error("pthread_create has failed: Resource temporarily unavailable");
      }),
      testing::ExitedWithCode(kExitFailure),
      "^no further thread can be started; fewer threads or more memory are needed\n$");
}

TEST(RunProgramDeathTest, StillAbortsWhereAnAssumptionOfOursIsBroken) {
  EXPECT_DEATH(EndsWhereNothingMayBeThrown([] { throw std::logic_error("cannot be"); }),
               "cannot be");
}

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
