#include "core/program/program.h"

#include <gtest/gtest.h>

#include <new>
#include <sstream>
#include <stdexcept>

#include "core/base/error.h"
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

}  // namespace
}  // namespace railcast
