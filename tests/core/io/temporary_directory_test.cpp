#include "tests/core/io/temporary_directory.h"
#include "tests/core/io/default_signals.h"

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

}  // namespace
}  // namespace railcast
