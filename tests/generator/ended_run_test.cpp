#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>

#include "tests/core/io/default_signals.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/example_run.h"
#include "tests/generator/project_folder.h"
#include "tests/generator/run_command.h"

namespace railcast {
namespace {

/// An endless `sequence` that writes to a directory.
class EndlessSequence {
 public:
  explicit EndlessSequence(std::string out, bool has_nohup = false) : out_(std::move(out)) {
    const std::string file = scenarios_folder + "minimal.json";
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
  const std::string scenario = scenarios_folder + "minimal.json";
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

}  // namespace
}  // namespace railcast
