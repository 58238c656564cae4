#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <utility>

#include "core/io/write_file.h"
#include "tests/core/io/default_signals.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/example_run.h"
#include "tests/generator/project_folder.h"
#include "tests/generator/run_command.h"
#include "tests/support/memory_limit.h"

namespace railcast {
namespace {

using testing::ContainsRegex;

/// An endless `sequence` that writes to a directory.
class EndlessSequence {
 public:
  explicit EndlessSequence(std::string out, bool has_nohup = false) : out_(std::move(out)) {
    const std::string file = kScenariosFolder + "minimal.json";
    child_ = ::fork();
    if (child_ > 0) return;
    UseDefaultSignals();
    if (has_nohup) ::signal(SIGHUP, SIG_IGN);
    ::execl(RAILCAST_GENERATE, RAILCAST_GENERATE, "sequence", file.c_str(), "--out", out_.c_str(),
            "--frames", "100000", "--fields", "x,y,z", nullptr);
    ::_exit(127);
  }

  [[nodiscard]] bool AwaitFrame(int number) const {
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "/frames/%06d.pcd", number);
    while (!std::filesystem::exists(out_ + name.data())) {
      if (::waitpid(child_, nullptr, WNOHANG) != 0) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
  }
  [[nodiscard]] int EndOn(int signal) const {
    ::kill(child_, signal);
    int status = 0;
    ::waitpid(child_, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  void Hang() const { ::kill(child_, SIGHUP); }

 private:
  std::string out_;
  pid_t child_{};
};

TEST(RailcastGenerate, StopsAfterAFrameOnCtrlCAndContinues) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const TemporaryDirectory directory;
    const std::string out = (directory.path() / "run").string();
    const EndlessSequence sequence(out);
    ASSERT_TRUE(sequence.AwaitFrame(1));
    EXPECT_EQ(sequence.EndOn(signal), 130) << signal;
    const auto contents = Contents(out);
    EXPECT_FALSE(contents.contains("manifest.json"));
    for (const auto& [name, bytes] : contents)
      EXPECT_EQ(name.find(".part"), std::string::npos) << name;
  }
}

TEST(RailcastGenerate, GoesOnUnderNohupWhenItsTerminalIsClosed) {
  const TemporaryDirectory directory;
  const EndlessSequence sequence((directory.path() / "run").string(), true);
  ASSERT_TRUE(sequence.AwaitFrame(1));
  sequence.Hang();
  // The frame under way would be completed in any case; frame 10 shows that the run goes on.
  EXPECT_TRUE(sequence.AwaitFrame(10));
  EXPECT_EQ(sequence.EndOn(SIGTERM), 130);
}

TEST(RailcastGenerate, NamesTheFileThatIsLargerThanAllowed) {
  const TemporaryDirectory directory;
  const std::string out = (directory.path() / "run").string();
  const std::string generate = std::string(RAILCAST_GENERATE) + " ";
  const std::string scenario = kScenariosFolder + "minimal.json";
  // 64 blocks of 512 bytes in every POSIX shell, which is enough for the text files beside the
  // frames.
  const auto limited = [&](const std::string& arguments) {
    const Ended ended = RunCommand("( ulimit -f 64; " + generate + arguments + " )");
    EXPECT_EQ(ended.status, 1) << ended.said;
    return ended.said;
  };
  const std::string sequence = "sequence " + scenario + " --frames 2 --out " + out;
  EXPECT_EQ(limited(sequence), out + "/frames/000000.pcd: file too large\n");
  const Ended resumed = Generate(sequence);
  EXPECT_EQ(resumed.status, 0) << resumed.said;
  const std::string world = (directory.path() / "world.ply").string();
  EXPECT_NE(limited("world " + scenario + " --from-s 400 --to-s 450 --out " + world)
                .find(world + ": file too large\n"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(world));
  const std::string capture = (directory.path() / "a.pcap").string();
  EXPECT_NE(limited("stream " + scenario + " --duration 1 --pcap " + capture)
                .find(capture + ": file too large; the capture ends after "),
            std::string::npos);
}

// Returns a wall of 180,000 triangles, 6 m x 4 m, to replace the project's rock.
std::string WallObj() {
  constexpr int kNumSteps = 300;
  std::ostringstream obj;
  for (int i = 0; i <= kNumSteps; ++i) {
    for (int j = 0; j <= kNumSteps; ++j) {
      obj << "v 0 " << 6.0 * j / kNumSteps - 3.0 << ' ' << 4.0 * i / kNumSteps << '\n';
    }
  }
  for (int i = 0; i < kNumSteps; ++i) {
    for (int j = 0; j < kNumSteps; ++j) {
      const int a = i * (kNumSteps + 1) + j + 1;
      const int b = a + kNumSteps + 1;
      obj << "f " << a << ' ' << a + 1 << ' ' << b + 1 << ' ' << b << '\n';
    }
  }
  return obj.str();
}

TEST(LittleMemory, MakesTheSameFramesOrSaysWhatDidNotFit) {
  if (!kCanLimitMemory) GTEST_SKIP() << "sanitizers reserve more than can be limited";
  const TemporaryDirectory directory;
  const std::string scenario = MakeProject(directory.path() / "project").string();
  WriteFileWhole(directory.path() / "project/rock.obj", WallObj());
  const auto sequence = [&](const std::string& out) {
    return "sequence " + scenario + " --frames 2 --threads 2 --out " + out;
  };
  const std::string whole = (directory.path() / "whole").string();
  ASSERT_EQ(Generate(sequence(whole)).status, 0);
  const std::string manifest = ReadFileWhole(whole + "/manifest.json");

  std::set<std::string> said;
  std::size_t num_made = 0;
  constexpr int kLibraries_mb = 60;
  for (int limit_mb = kLibraries_mb; limit_mb < 640; limit_mb += num_made == 0 ? 8 : 160) {
    const std::string out = (directory.path() / std::to_string(limit_mb)).string();
    const Ended run = RunCommand("ulimit -v " + std::to_string(limit_mb * 1024) + "; " +
                                 RAILCAST_GENERATE + " " + sequence(out));
    if (run.said.find("loading shared libraries") != std::string::npos) continue;
    if (run.status == 0) {
      ++num_made;
      EXPECT_EQ(ReadFileWhole(out + "/manifest.json"), manifest) << limit_mb;
      continue;
    }
    said.insert(run.said);
    EXPECT_EQ(run.status, 1) << limit_mb << ": " << run.said;
    EXPECT_EQ(std::count(run.said.begin(), run.said.end(), '\n'), 1) << run.said;
    EXPECT_THAT(run.said, ContainsRegex("out of memory|no (further )?thread can be started"));
    EXPECT_FALSE(std::filesystem::exists(out + "/manifest.json"));
  }
  EXPECT_GT(num_made, 0U);
  // Which model or part of the line fails depends on the machine's libraries.
  EXPECT_THAT(said, testing::Contains(testing::HasSubstr("out of memory while building ")));
}

}  // namespace
}  // namespace railcast
