#include <gtest/gtest.h>

#include <string>

#include "core/io/write_file.h"
#include "tests/viewer/program/recorded_run.h"
#include "tests/viewer/program/view_program.h"

namespace railcast {
namespace {

using Bytes = Drawn;

// llvmpipe, Mesa's software renderer, uses as many threads as LP_NUM_THREADS says.
TEST_F(Bytes, AreTheSameEveryTimeWithAnyNumberOfThreads) {
  const std::string run = RecordedRun::Yard().path().string();
  for (const std::string options :
       {"", "--show surfaces,boxes,track,gauge,frustum,axes,rings,empty-beams ",
        "--color-by noise --accumulate 4 --frame 5 --background white "}) {
    const auto bytes = [&](const std::string& before) {
      const std::string file = PathOf("out.png");
      const Ended ended =
          RunCommand(before + RAILCAST_VIEW " --screenshot " + file + " " + options + run);
      EXPECT_EQ(ended.status, 0) << ended.said;
      return ReadFileWhole(file);
    };
    const std::string once = bytes("");
    EXPECT_GT(once.size(), 10'000U);
    for (const std::string before :
         {"", "LP_NUM_THREADS=0 ", "LP_NUM_THREADS=1 ", "LP_NUM_THREADS=2 ", "taskset -c 0 "}) {
      EXPECT_TRUE(bytes(before) == once) << before << options;
    }
  }
}

}  // namespace
}  // namespace railcast
