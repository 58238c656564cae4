#include "core/base/error.h"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "core/base/out_of_memory.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

TEST(ErrorList, ThrowsEveryLineAtOnce) {
  ErrorList errors;
  EXPECT_NO_THROW(errors.ThrowIfAny());
  errors.Add({"a.json: /x", "must be > 0", "-1"});
  errors.Add({"a.json: /y", "missing", ""});
  EXPECT_EQ(MessageOf([&] { errors.ThrowIfAny(); }),
            "a.json: /x: must be > 0 (got -1)\na.json: /y: missing");
}

TEST(ErrorList, KeepsEachLineOnce) {
  ErrorList errors;
  for (const char* line : {"a", "b", "a"}) errors.AddLine(line);
  EXPECT_EQ(errors.lines(), (std::vector<std::string>{"a", "b"}));
}

TEST(CheckDeathTest, NamesPlaceAndAssumption) {
  EXPECT_DEATH(Check(false, "sum is one"), "error_test.cpp:[0-9]+: broken assumption: sum is one");
}

TEST(InputError, ShowsTheFirstTwentyFaultsAndHowManyThereAreMore) {
  ErrorList errors;
  for (int i = 0; i < 200'000; ++i)
    errors.Add({"a.json: /" + std::to_string(i), "unknown key", ""});
  std::string twenty;
  for (int i = 0; i < 20; ++i) twenty += "a.json: /" + std::to_string(i) + ": unknown key\n";
  try {
    errors.ThrowIfAny();
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), twenty + "... and 199980 more faults");
    EXPECT_EQ(error.faults().size(), 200'000U);
  }
  twenty.pop_back();
  EXPECT_EQ(InputError(twenty).what(), twenty);
  EXPECT_EQ(InputError(twenty + "\nb\nc").what(), twenty + "\n... and 2 more faults");
}

TEST(UnknownPlaces, KnowEverythingWhereNothingIsFaulty) {
  EXPECT_TRUE(UnknownPlaces().IsKnown(""));
  EXPECT_TRUE(UnknownPlaces().IsKnown("/world/tracks/0"));
}

TEST(UnknownPlaces, ReachUpAndDownFromAFaultButNotAside) {
  UnknownPlaces unknown;
  unknown.Add("/world/objects/1");
  EXPECT_FALSE(unknown.IsKnown(""));
  EXPECT_FALSE(unknown.IsKnown("/world"));
  EXPECT_FALSE(unknown.IsKnown("/world/objects/1"));
  EXPECT_FALSE(unknown.IsKnown("/world/objects/1/s_m"));
  EXPECT_TRUE(unknown.IsKnown("/world/objects/0"));
  EXPECT_TRUE(unknown.IsKnown("/world/tracks"));
}

TEST(UnknownPlaces, DoNotMistakeAKeyForOneThatItBeginsWith) {
  UnknownPlaces unknown;
  unknown.Add("/world/objects/10");
  unknown.Add("/world/track-gauge");
  EXPECT_TRUE(unknown.IsKnown("/world/objects/1"));
  EXPECT_TRUE(unknown.IsKnown("/world/track"));
}

TEST(UnknownPlaces, HoldEverythingWhereTheWholeIsFaulty) {
  UnknownPlaces unknown;
  unknown.Add("");
  EXPECT_FALSE(unknown.IsKnown("/seed"));
}

std::string Doing() {
  return "building a wall (2 triangles)";
}

std::string MessageOfMaking(const std::function<void()>& make) {
  return MessageOf([&] { WithinMemory(Doing, make); });
}

TEST(OutOfMemory, GivesWhatIsMade) {
  EXPECT_EQ(WithinMemory(Doing, [] { return 3; }), 3);
}

TEST(OutOfMemory, SaysWhatDidNotFit) {
  EXPECT_EQ(MessageOfMaking([] { throw std::bad_alloc(); }),
            "out of memory while building a wall (2 triangles)");
  EXPECT_EQ(MessageOfMaking([] {
              std::vector<double> endless;
              endless.resize(endless.max_size() + 1);
            }),
            "out of memory while building a wall (2 triangles)");
}

TEST(OutOfMemory, SaysWhatNoThreadCanBeStartedFor) {
  EXPECT_EQ(
      MessageOfMaking([] {
        throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
      }),
      "no thread can be started while building a wall (2 triangles)");
}

TEST(OutOfMemory, LeavesTheInnermostPlaceToSpeak) {
  EXPECT_EQ(MessageOfMaking([] {
              WithinMemory([] { return "reading a brick"; }, [] { throw std::bad_alloc(); });
            }),
            "out of memory while reading a brick");
}

TEST(OutOfMemory, LetsOtherErrorsPass) {
  EXPECT_THROW(WithinMemory(Doing, [] { throw std::out_of_range("3"); }), std::out_of_range);
  EXPECT_THROW(
      WithinMemory(Doing,
                   [] { throw std::system_error(std::make_error_code(std::errc::io_error)); }),
      std::system_error);
}

TEST(StartThread, DoesTheWork) {
  int done = 0;
  StartThread("counting", [&] { ++done; }).join();
  EXPECT_EQ(done, 1);
}

TEST(OutOfMemory, TellsTheSizeOfAFile) {
  const std::string file = testing::TempDir() + "out_of_memory_test.txt";
  std::ofstream(file) << "12345";
  EXPECT_EQ(ReadingText(file), "reading " + file + " (5 bytes)");
  std::remove(file.c_str());
  EXPECT_EQ(ReadingText(file), "reading " + file);
}

}  // namespace
}  // namespace railcast
