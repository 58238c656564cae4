#include "core/mesh/limited_process.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <stdexcept>
#include <vector>

#include "core/base/error.h"
#include "tests/support/memory_limit.h"

namespace railcast {
namespace {

using Kind = ProcessEnd::Kind;

constexpr ProcessLimits kEnough = {.memory_bytes = 500'000'000, .time_s = 60};

// More than a pipe holds at once.
TEST(RunLimited, GivesBackWhatTheWorkReturns) {
  const std::string bytes(3'000'000, 'x');
  const ProcessEnd end = RunLimited(kEnough, [&] { return bytes; });
  EXPECT_EQ(end.kind, Kind::kDone);
  EXPECT_EQ(end.bytes, bytes);
  EXPECT_EQ(RunLimited(kEnough, [] { return std::string(); }).kind, Kind::kDone);
}

TEST(RunLimited, ChangesNothingInThisProcess) {
  int number = 1;
  EXPECT_EQ(RunLimited(kEnough,
                       [&] {
                         number = 2;
                         return std::to_string(number);
                       })
                .bytes,
            "2");
  EXPECT_EQ(number, 1);
}

TEST(RunLimited, TellsFaultsOfTheInput) {
  const ProcessEnd end =
      RunLimited(kEnough, []() -> std::string { throw InputError("a: must be b\nc: must be d"); });
  EXPECT_EQ(end.kind, Kind::kFault);
  EXPECT_EQ(end.bytes, "a: must be b\nc: must be d");
}

TEST(RunLimited, EndsWorkThatTakesTooMuchMemory) {
  if (!kCanLimitMemory) GTEST_SKIP() << "sanitizers reserve more than can be limited";
  const ProcessEnd end = RunLimited({.memory_bytes = 50'000'000, .time_s = 60}, [] {
    std::vector<std::string> all;
    while (true) all.emplace_back(1'000'000, 'x');
    return std::string();
  });
  EXPECT_EQ(end.kind, Kind::kLackMemory);
}

TEST(RunLimited, EndsWorkThatTakesTooLong) {
  const ProcessEnd end = RunLimited({.memory_bytes = 50'000'000, .time_s = 1}, [] {
    std::string text;
    while (text.size() < 2) text = std::to_string(text.size());
    return text;
  });
  EXPECT_EQ(end.kind, Kind::kLackTime);
}

TEST(RunLimited, OutlivesWorkThatBreaksDown) {
  EXPECT_EQ(RunLimited(kEnough,
                       []() -> std::string {
                         ::raise(SIGSEGV);
                         return "";
                       })
                .kind,
            Kind::kBroken);
  EXPECT_EQ(RunLimited(kEnough, []() -> std::string { ::_exit(0); }).kind, Kind::kBroken);
  EXPECT_EQ(RunLimited(kEnough, []() -> std::string { throw std::logic_error("a bug"); }).kind,
            Kind::kBroken);
}

}  // namespace
}  // namespace railcast
