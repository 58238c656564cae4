#include "generator/run/stopping.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cstdlib>

#include "core/program/program.h"
#include "core/program/stop_signals.h"
#include "tests/core/io/default_signals.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

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

}  // namespace
}  // namespace railcast
