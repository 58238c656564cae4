#include "generator/run/frame_pipe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/program/program.h"
#include "core/program/stop_signals.h"
#include "generator/run/stopping.h"
#include "tests/core/io/default_signals.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/example_run.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

using testing::ElementsAre;

/// A pipe of numbers from 0 on, in which each work takes longer for some numbers than for others.
struct NumberPipe {
  FramePipe pipe;
  std::vector<int> slots;
  std::vector<int> in_order;  ///< Numbers in the stage that takes one after another.
  std::vector<int> written;
  int num_told = 0;
  int num_begun = 0;
  /// Where the work on number 20 fails: "begin", "parallel", "in order" or "write".
  std::string fails_at;
  std::function<void()> fault = [] { throw std::runtime_error("20 is bad"); };

  explicit NumberPipe(int num) {
    pipe.num_at_once = 4;
    pipe.num_waiting = 2;
    slots.assign(pipe.num_slots(), -1);
    pipe.execute = [](const std::function<void()>& work) { work(); };
    pipe.begin = [this, num](std::size_t slot) {
      if (num_begun == num) return false;
      slots[slot] = num_begun++;
      Work("begin", slot);
      return true;
    };
    pipe.stages = {{false, [this](std::size_t slot) { Work("parallel", slot); }},
                   {true, [this](std::size_t slot) {
                      Work("in order", slot);
                      in_order.push_back(slots[slot]);
                    }}};
    pipe.write = [this](std::size_t slot) {
      Work("write", slot);
      written.push_back(slots[slot]);
    };
    pipe.on_written = [this] { ++num_told; };
  }

  void Work(const std::string& what, std::size_t slot) const {
    constexpr int kUneven = 7;
    if (what != "begin") {
      std::this_thread::sleep_for(std::chrono::microseconds(300 * (slots[slot] % kUneven)));
    }
    if (what == fails_at && slots[slot] == 20) fault();
  }
};

std::vector<int> FirstNumbers(int num) {
  std::vector<int> numbers(static_cast<std::size_t>(num));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

TEST(RunPipe, WritesAllFramesInTheirOrder) {
  NumberPipe numbers(100);
  RunPipe(numbers.pipe);
  EXPECT_EQ(numbers.in_order, FirstNumbers(100));
  EXPECT_EQ(numbers.written, FirstNumbers(100));
  EXPECT_EQ(numbers.num_told, 100);
}

TEST(RunPipe, PassesAFaultOnOnceTheFramesBeforeItAreWritten) {
  for (const char* const where : {"begin", "parallel", "in order"}) {
    NumberPipe numbers(100);
    numbers.fails_at = where;
    EXPECT_THROW(RunPipe(numbers.pipe), std::runtime_error) << where;
    EXPECT_EQ(numbers.written, FirstNumbers(20)) << where;
    EXPECT_EQ(numbers.num_told, 20) << where;
  }
}

TEST(RunPipe, WritesNothingAfterWhatCouldNotBeWritten) {
  NumberPipe numbers(100);
  numbers.fails_at = "write";
  EXPECT_THROW(RunPipe(numbers.pipe), std::runtime_error);
  EXPECT_EQ(numbers.written, FirstNumbers(20));
  EXPECT_EQ(numbers.num_told, 20);
}

TEST(RunPipe, EndsAfterTheFramesBeforeAStopWithoutAFault) {
  for (const char* const where : {"begin", "parallel"}) {
    NumberPipe numbers(100);
    numbers.fails_at = where;
    numbers.fault = [] { throw RunStopped(); };
    RunPipe(numbers.pipe);
    EXPECT_EQ(numbers.written, FirstNumbers(20)) << where;
  }
}

// Each test runs in a process of its own, because the request to stop is global and cannot be
// withdrawn.

/// Waits until the process is ended, at most 20 s.
void BeBusy() {
  for (int i = 0; i < 20; ++i) ::sleep(1);
}

TEST(StopSignal, IsARequestThatTheProgramAsksFor) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EXIT(
        {
          UseDefaultSignals();
          CatchStopSignals();
          if (StopRequested()) std::exit(1);
          ::raise(signal);
          std::exit(StopRequested() ? 0 : 2);
        },
        testing::ExitedWithCode(0), "");
  }
}

TEST(StopSignal, EndsAtOnceAtTheSecond) {
  EXPECT_EXIT(
      {
        UseDefaultSignals();
        CatchStopSignals();
        ::raise(SIGINT);
        ::raise(SIGINT);
      },
      testing::KilledBySignal(SIGINT), "");
}

TEST(StopSignal, EndsWorkThatCannotBeStopped) {
  EXPECT_EXIT(
      {
        UseDefaultSignals();
        CatchStopSignals();
        UseStopDeadline(true);
        ::raise(SIGINT);
        BeBusy();
      },
      testing::ExitedWithCode(kExitInterrupted), "^interrupted\n$");
}

TEST(StopSignal, LeavesWorkAloneThatIsDoneInTime) {
  EXPECT_EXIT(
      {
        UseDefaultSignals();
        CatchStopSignals();
        UseStopDeadline(true);
        ::raise(SIGINT);
        UseStopDeadline(false);
        ::sleep(3);
        ::_exit(7);
      },
      testing::ExitedWithCode(7), "^$");
}

TEST(WatchBuilding, EndsAFrameWhoseSceneIsNotBuiltYetOnceTheRunIsStopped) {
  Simulator simulator(std::make_shared<SimpleWorld>(), MakeRaster(10, 10, 1), TestMaterials(), {},
                      1);
  bool is_stopped = true;
  WatchBuilding(
      simulator, [&] { return is_stopped; }, true);
  Frame frame;
  EXPECT_THROW(simulator.Scan(0, frame), RunStopped);
  is_stopped = false;
  simulator.Scan(0, frame);
  EXPECT_EQ(frame.num_slots(), simulator.pattern().num_firings());
  // The scene has been built already, so the stop has no effect.
  is_stopped = true;
  simulator.Scan(1, frame);
  EXPECT_EQ(frame.index, 1U);
}

/// Frames 3, 8, 13, 18 of the example.
SequenceSpec SparseRun(const std::filesystem::path& directory, const std::string& format = "pcd") {
  SequenceSpec spec = ExampleRun(directory, format, 4);
  spec.stride = 5;
  return spec;
}

TEST(Stride, ChoosesTheFramesAndNamesTheirFilesByTheirNumbers) {
  const TemporaryDirectory directory;
  std::vector<std::uint32_t> made;
  const ExampleFrames make = [&](std::uint32_t index, Frame& frame, auto& objects) {
    made.push_back(index);
    MakeExampleFrame(index, frame, objects);
  };
  EXPECT_TRUE(RunSequence(SparseRun(directory.path()), make, NoHooks()).is_complete);
  EXPECT_THAT(made, ElementsAre(3, 8, 13, 18));
  const auto contents = Contents(directory.path());
  EXPECT_TRUE(contents.contains("frames/000018.pcd"));
  EXPECT_FALSE(contents.contains("frames/000004.pcd"));
}

TEST(Stride, NumbersTheFilesOfKittiOneAfterAnother) {
  const TemporaryDirectory directory;
  (void)RunSequence(SparseRun(directory.path(), "kitti"), MakeExampleFrame, NoHooks());
  const auto contents = Contents(directory.path());
  EXPECT_TRUE(contents.contains("sequences/00/velodyne/000003.bin"));
  EXPECT_FALSE(contents.contains("sequences/00/velodyne/000004.bin"));
}

TEST(Stride, AStoppedRunContinuesWithTheSameBytes) {
  for (const char* const format : {"pcd", "kitti"}) {
    const TemporaryDirectory directory;
    (void)RunSequence(SparseRun(directory.path() / "whole", format), MakeExampleFrame, NoHooks());
    const SequenceSpec stopped = SparseRun(directory.path() / "stopped", format);
    int num_frames = 0;
    const SequenceHooks hooks = {[](std::uint32_t, std::uint32_t) {},
                                 [&] { return ++num_frames > 2; }};
    EXPECT_FALSE(RunSequence(stopped, MakeExampleFrame, hooks).is_complete);
    const SequenceResult rest = RunSequence(stopped, MakeExampleFrame, NoHooks());
    EXPECT_EQ(rest.num_resumed, 2U);
    EXPECT_EQ(Contents(directory.path() / "stopped"), Contents(directory.path() / "whole"));
  }
}

TEST(Stride, BelongsToTheRun) {
  const TemporaryDirectory directory;
  const auto message = [&](std::uint32_t stride) {
    SequenceSpec spec = SparseRun(directory.path());
    spec.stride = stride;
    return MessageOf([&] { (void)RunSequence(spec, MakeExampleFrame, NoHooks()); });
  };
  EXPECT_EQ(message(5), "no error");
  const std::string place = directory.path().string() + ": ";
  EXPECT_EQ(message(4),
            place + "holds another run: its --stride is 5 (got 4); choose another --out");
  EXPECT_EQ(message(1),
            place + "holds another run: its --stride is 5 (got 1); choose another --out");
}

TEST(Stride, IsOneWhereTheRunDoesNotSay) {
  const TemporaryDirectory directory;
  SequenceSpec spec = SparseRun(directory.path());
  spec.stride = 1;
  (void)RunSequence(spec, MakeExampleFrame, NoHooks());
  spec.stride = 2;
  EXPECT_EQ(MessageOf([&] { (void)RunSequence(spec, MakeExampleFrame, NoHooks()); }),
            directory.path().string() +
                ": holds another run: its --stride is 1 (got 2); choose another --out");
}

}  // namespace
}  // namespace railcast
