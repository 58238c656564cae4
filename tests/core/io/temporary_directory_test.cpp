#include "tests/core/io/temporary_directory.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "tests/core/io/default_signals.h"
#include "tests/core/io/small_disk.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

// Returns the directory that a separate process made for life before the signal ended it.
fs::path LeftBehindBy(int signal) {
  std::array<int, 2> ends{};
  EXPECT_EQ(::pipe(ends.data()), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    UseDefaultSignals();
    const std::string directory = MakeDirectoryForLife().string();
    std::ofstream(fs::path(directory) / "file") << "full";
    const bool is_said = ::write(ends[1], directory.data(), directory.size()) > 0;
    ::raise(is_said ? signal : SIGUSR1);
  }
  ::close(ends[1]);
  std::string said(4096, '\0');
  const ssize_t count = ::read(ends[0], said.data(), said.size());
  said.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(WTERMSIG(status), signal);
  return said;
}

TEST(TemporaryDirectory, GoesAwayHoweverItsProcessEnds) {
  for (const int signal : {SIGABRT, SIGKILL, SIGINT}) {
    const fs::path left = LeftBehindBy(signal);
    ASSERT_FALSE(left.empty());
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (fs::exists(left) && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_FALSE(fs::exists(left)) << signal;
  }
}

namespace fs = std::filesystem;

// Returns the error with which a test that asks for this work would fail, or "no error".
std::string FailureOf(const std::function<std::string(const fs::path&)>& work) {
  const TemporaryDirectory directory;
  try {
    const auto result = RunOnSmallDisk(directory.path(), work);
    return result.refused.empty() ? "no error" : result.refused;
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

class SmallDisk : public testing::Test {
 protected:
  void SetUp() override {
    const std::string failure = FailureOf([](const fs::path&) { return ""; });
    if (failure != "no error") GTEST_SKIP() << failure;
  }
};

TEST_F(SmallDisk, FailsWithWhatItsWorkThrows) {
  EXPECT_EQ(FailureOf([](const fs::path&) -> std::string { throw std::runtime_error("no"); }),
            "the work on the small disk threw: no");
}

TEST_F(SmallDisk, FailsWhereItsProcessDies) {
  EXPECT_EQ(FailureOf([](const fs::path&) {
              ::raise(SIGKILL);
              return "";
            }),
            "the process on the small disk died with status 9 (said \"m\")");
}

}  // namespace
}  // namespace railcast
