#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>

#include "core/base/error.h"
#include "core/io/write_file.h"
#include "generator/run/make_frames.h"
#include "generator/run/stopping.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/example_run.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

void MakeExampleFrameSlowly(std::uint32_t index,
                            Frame& frame,
                            std::vector<ObjectInFrame>& objects) {
  MakeExampleFrame(index, frame, objects);
  // The last ones are never reached: the process is killed long before.
  constexpr std::uint32_t kFrameNeverMade = 36;
  if (index >= kFrameNeverMade) std::this_thread::sleep_for(std::chrono::minutes(1));
  std::this_thread::sleep_for(std::chrono::microseconds(300));
}

SequenceSpec RunOf40Frames(const fs::path& directory, const std::string& format) {
  return ExampleRun(directory, format, 40);
}

constexpr const char* kDirectoryOfChild = "RAILCAST_TEST_DIRECTORY";
constexpr const char* kFormatOfChild = "RAILCAST_TEST_FORMAT";

// What RunAndKill() starts.
TEST(DISABLED_ChildOfInterruptedRun, MakesTheExampleSlowly) {
  const char* const directory = ::getenv(kDirectoryOfChild);
  const char* const format = ::getenv(kFormatOfChild);
  if (directory == nullptr || format == nullptr) GTEST_SKIP() << "no run to make";
  (void)RunSequence(RunOf40Frames(directory, format), MakeExampleFrameSlowly, NoHooks());
}

// Runs the example in a separate process and kills it some time after frames.jsonl has reached this
// size, so that it is in the middle of some step of some frame. The process is this program, begun
// anew: after fork() alone, it might wait forever for a lock that a thread of TBB held.
void RunAndKill(const SequenceSpec& spec,
                const std::string& format,
                std::uint64_t frames_bytes,
                std::chrono::microseconds delay) {
  // Before the fork, after which a child of several threads may do next to nothing.
  ::setenv(kDirectoryOfChild, spec.directory.c_str(), 1);
  ::setenv(kFormatOfChild, format.c_str(), 1);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ::execl("/proc/self/exe", "child", "--gtest_also_run_disabled_tests", "--gtest_brief=1",
            "--gtest_filter=DISABLED_ChildOfInterruptedRun.*", nullptr);
    ::_exit(127);
  }
  std::error_code no_file_yet;
  const fs::path frames = spec.directory / "frames.jsonl";
  while (::waitpid(child, nullptr, WNOHANG) == 0) {
    const std::uintmax_t size = fs::file_size(frames, no_file_yet);
    if (no_file_yet || size < frames_bytes) {
      std::this_thread::sleep_for(std::chrono::microseconds(50));
      continue;
    }
    std::this_thread::sleep_for(delay);
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    return;
  }
  ADD_FAILURE() << "the process ended by itself";
}

class InterruptedRun : public testing::TestWithParam<const char*> {
 protected:
  // Returns the content of a run that was not interrupted.
  std::map<std::string, std::string> Undisturbed() {
    const TemporaryDirectory directory;
    (void)RunSequence(Spec(directory.path()), MakeExampleFrame, NoHooks());
    return Contents(directory.path());
  }
  SequenceSpec Spec(const fs::path& directory) { return RunOf40Frames(directory, GetParam()); }
};

TEST_P(InterruptedRun, GivesTheSameBytesHoweverOftenItIsKilled) {
  const auto expected = Undisturbed();
  const std::uint64_t whole = expected.at("frames.jsonl").size();
  constexpr std::uint64_t kTrials = 10;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    const TemporaryDirectory directory;
    const std::chrono::microseconds delay(75 * trial);
    RunAndKill(Spec(directory.path()), GetParam(), whole * trial / kTrials / 3, delay);
    RunAndKill(Spec(directory.path()), GetParam(), whole * (trial + kTrials) / kTrials / 3, delay);
    const auto result = RunSequence(Spec(directory.path()), MakeExampleFrame, NoHooks());
    EXPECT_TRUE(result.is_complete);
    ASSERT_EQ(Contents(directory.path()), expected) << "trial " << trial;
  }
}

TEST_P(InterruptedRun, ContinuesAfterAStopBetweenFrames) {
  const TemporaryDirectory directory;
  std::uint32_t last_done = 0;
  const SequenceHooks stop_after_five = {
      [&](std::uint32_t num_done, std::uint32_t) { last_done = num_done; },
      [&] { return last_done >= 5; }};
  const auto first = RunSequence(Spec(directory.path()), MakeExampleFrame, stop_after_five);
  EXPECT_FALSE(first.is_complete);
  EXPECT_EQ(first.num_done, 6U);  // The frame under way was still written.
  EXPECT_FALSE(fs::exists(directory.path() / "manifest.json"));
  std::uint32_t num_made = 0;
  const ExampleFrames counting = [&](std::uint32_t index, Frame& frame, auto& objects) {
    ++num_made;
    MakeExampleFrame(index, frame, objects);
  };
  const auto second = RunSequence(Spec(directory.path()), counting, NoHooks());
  EXPECT_EQ(second.num_resumed, 6U);
  EXPECT_EQ(num_made, 34U);
  EXPECT_EQ(Contents(directory.path()), Undisturbed());
}

// Checks states that a directory may be left in when the machine stops, and not only the program.
TEST_P(InterruptedRun, DropsWhateverIsNotWhole) {
  const auto expected = Undisturbed();
  const std::string frame_7 =
      GetParam() == std::string("kitti") ? "sequences/00/labels/000007.label" : "frames/000010.pcd";
  const std::vector<std::function<void(const fs::path&)>> damages = {
      [](const fs::path& d) {
        fs::resize_file(d / "frames.jsonl", fs::file_size(d / "frames.jsonl") - 5);
      },
      [](const fs::path& d) { fs::resize_file(d / "frames.jsonl", 0); },
      [](const fs::path& d) { fs::resize_file(d / "poses.csv", 100); },
      [](const fs::path& d) {
        fs::resize_file(d / "objects.jsonl", fs::file_size(d / "objects.jsonl") / 2);
      },
      [](const fs::path& d) { fs::remove(d / "poses.csv"); },
      [&](const fs::path& d) { fs::remove(d / frame_7); },
      [&](const fs::path& d) { fs::resize_file(d / frame_7, 40); },
      [&](const fs::path& d) {
        WriteFileWhole(d / frame_7, std::string(fs::file_size(d / frame_7), '\0'));
      },
      [&](const fs::path& d) { WriteFileWhole(d / (frame_7 + ".part"), "half"); },
      [](const fs::path& d) { fs::remove(d / "labels.json"); },
  };
  for (std::size_t i = 0; i < damages.size(); ++i) {
    const TemporaryDirectory directory;
    (void)RunSequence(Spec(directory.path()), MakeExampleFrame, NoHooks());
    fs::remove(directory.path() / "manifest.json");
    damages[i](directory.path());
    (void)RunSequence(Spec(directory.path()), MakeExampleFrame, NoHooks());
    EXPECT_EQ(Contents(directory.path()), expected) << "damage " << i;
  }
}

TEST_P(InterruptedRun, KeepsWhatWasWrittenWhenAFrameCannotBeMade) {
  const TemporaryDirectory directory;
  const ExampleFrames failing = [](std::uint32_t index, Frame& frame, auto& objects) {
    if (index == 8) throw std::runtime_error("no frame 8");
    MakeExampleFrame(index, frame, objects);
  };
  EXPECT_THROW((void)RunSequence(Spec(directory.path()), failing, NoHooks()), std::runtime_error);
  const auto result = RunSequence(Spec(directory.path()), MakeExampleFrame, NoHooks());
  EXPECT_EQ(result.num_resumed, 5U);
  EXPECT_EQ(Contents(directory.path()), Undisturbed());
}

TEST_P(InterruptedRun, KeepsWhatWasBegunBeforeAFrameThatCannotBeMadeOfSeveralAtOnce) {
  for (const bool is_begun : {false, true}) {
    const TemporaryDirectory directory;
    const BeginFrame failing = [&](std::uint32_t index) -> FrameJob {
      if (index == 8 && !is_begun) throw InputError("no frame 8");
      return [index](MadeFrame& made) {
        if (index == 8) throw InputError("no frame 8");
        made.objects.clear();
        MakeUnevenFrame(index, made.frame, made.objects);
      };
    };
    EXPECT_EQ(MessageOf([&] {
                (void)RunSequence(Spec(directory.path()), failing, NoHooks(), AtOnce(5));
              }),
              "no frame 8");
    const auto result =
        RunSequence(Spec(directory.path()), MakeUnevenFrame, NoHooks(), {}, AtOnce(5));
    EXPECT_EQ(result.num_resumed, 5U) << "from frame 3 on";
    EXPECT_EQ(Contents(directory.path()), Undisturbed());
  }
}

TEST_P(InterruptedRun, EndsAfterTheFramesUnderWayWhenItIsStopped) {
  const TemporaryDirectory directory;
  std::atomic<std::uint32_t> num_made = 0;
  const ExampleFrames counting = [&](std::uint32_t index, Frame& frame, auto& objects) {
    MakeUnevenFrame(index, frame, objects);
    ++num_made;
  };
  const SequenceHooks stop = {[](std::uint32_t, std::uint32_t) {}, [&] { return num_made >= 5; }};
  const auto first = RunSequence(Spec(directory.path()), counting, stop, {}, AtOnce(4));
  EXPECT_FALSE(first.is_complete);
  EXPECT_EQ(first.num_done, num_made) << "none of the frames under way is lost";
  EXPECT_LE(first.num_done, 9U);
  EXPECT_TRUE(
      RunSequence(Spec(directory.path()), MakeUnevenFrame, NoHooks(), {}, AtOnce(4)).is_complete);
  EXPECT_EQ(Contents(directory.path()), Undisturbed());
}

TEST_P(InterruptedRun, ContinuesAfterAStopInTheMiddleOfAFrame) {
  const TemporaryDirectory directory;
  const ExampleFrames stopped = [](std::uint32_t index, Frame& frame, auto& objects) {
    if (index == 8) throw RunStopped();
    MakeExampleFrame(index, frame, objects);
  };
  const auto first = RunSequence(Spec(directory.path()), stopped, NoHooks());
  EXPECT_FALSE(first.is_complete);
  EXPECT_EQ(first.num_done, 5U) << "from frame 3 on";
  EXPECT_TRUE(RunSequence(Spec(directory.path()), MakeExampleFrame, NoHooks()).is_complete);
  EXPECT_EQ(Contents(directory.path()), Undisturbed());
}

INSTANTIATE_TEST_SUITE_P(Formats, InterruptedRun, testing::Values("pcd", "kitti"));

}  // namespace
}  // namespace railcast
