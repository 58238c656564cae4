#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <set>
#include <string>

#include "core/io/write_file.h"
#include "tests/viewer/program/recorded_run.h"
#include "tests/viewer/program/running_program.h"
#include "tests/viewer/program/view_program.h"

namespace railcast {
namespace {

class Video : public Drawn {
 protected:
  static std::set<std::string> NamesIn(const std::filesystem::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      names.insert(entry.path().filename().string());
    }
    return names;
  }
  const std::string path_ = RecordedRun::Yard().path().string();
};

TEST_F(Video, HasTheBytesOfEachFramesScreenshot) {
  const Ended ended = View("--size 640x480 --video " + PathOf("all") + " " + path_);
  ASSERT_EQ(ended.status, 0) << ended.said;
  const std::set<std::string> expected = {"000000.png", "000001.png", "000002.png",
                                          "000003.png", "000004.png", "000005.png"};
  EXPECT_EQ(NamesIn(PathOf("all")), expected);
  int frame = 0;
  for (const std::string& name : expected) {
    (void)Draw("--frame " + std::to_string(frame++) + " " + path_);
    EXPECT_TRUE(ReadFileWhole(PathOf("all/" + name)) == ReadFileWhole(PathOf("out.png"))) << name;
  }
}

TEST_F(Video, BeginsAtAFrameAndHasAsManyAsAskedFor) {
  ASSERT_EQ(
      View("--size 640x480 --frame 2 --frames 3 --video " + PathOf("some") + " " + path_).status,
      0);
  EXPECT_EQ(NamesIn(PathOf("some")),
            (std::set<std::string>{"000000.png", "000001.png", "000002.png"}));
  (void)Draw("--frame 4 " + path_);
  EXPECT_TRUE(ReadFileWhole(PathOf("some/000002.png")) == ReadFileWhole(PathOf("out.png")));
}

TEST_F(Video, ReplacesNothing) {
  Write("taken/note.txt", "mine\n");
  const Ended ended = View("--video " + PathOf("taken") + " " + path_);
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(ended.said, "error: " + PathOf("taken") + ": must be empty or not be there yet\n");
  EXPECT_EQ(NamesIn(PathOf("taken")), (std::set<std::string>{"note.txt"}));
}

TEST_F(Video, AndScreenshotsKeepOutOfTheSequence) {
  for (const std::string& out :
       {"--video " + path_ + "/film", "--screenshot " + path_ + "/v.png"}) {
    const Ended ended = View(out + " " + path_);
    EXPECT_EQ(ended.status, 1);
    EXPECT_TRUE(
        ended.said.starts_with("error: " + out.substr(0, out.find(' ')) + ": must be outside "))
        << ended.said;
  }
}

TEST_F(Video, LeavesWholePicturesOnlyWhenItIsKilled) {
  std::filesystem::create_directories(PathOf("clouds"));
  for (int i = 0; i < 300; ++i) {
    std::filesystem::create_symlink(RecordedRun::Yard().path() / "frames/000000.pcd",
                                    PathOf("clouds/" + std::to_string(i) + ".pcd"));
  }
  RunningProgram program(
      {RAILCAST_VIEW, "--size", "1280x720", "--video", PathOf("video"), PathOf("clouds")},
      PathOf("said.txt"));
  EXPECT_TRUE(
      program.WaitUntil([&] { return std::filesystem::exists(PathOf("video/000004.png")); }));
  program.Kill();
  const auto names = NamesIn(PathOf("video"));
  EXPECT_GE(names.size(), 5U);
  EXPECT_LT(names.size(), 300U);
  for (const std::string& name : names) {
    if (!name.ends_with(".png")) continue;
    EXPECT_EQ(ReadPicture(PathOf("video/" + name)).width, 1280) << name;
    EXPECT_EQ(ReadFileWhole(PathOf("video/" + name)).substr(1, 3), "PNG");
    EXPECT_NE(ReadFileWhole(PathOf("video/" + name)).find("IEND"), std::string::npos);
  }
}

using Bytes = Drawn;

// llvmpipe, Mesa's software renderer, uses as many threads as LP_NUM_THREADS says.
TEST_F(Bytes, AreTheSameEveryTimeWithAnyNumberOfThreads) {
  const std::string run = RecordedRun::Yard().path().string();
  for (const std::string options :
       {"--show surfaces,boxes,track,gauge,frustum,axes,rings,empty-beams ",
        "--color-by noise --accumulate 4 --frame 5 --background white "}) {
    const auto bytes = [&](const std::string& before) {
      const std::string file = PathOf("out.png");
      const Ended ended = RunCommand(before + RAILCAST_VIEW " --size 640x480 --screenshot " + file +
                                     " " + options + run);
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
