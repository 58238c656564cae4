#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include "core/io/write_file.h"
#include "tests/core/io/default_signals.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/insert/run/made_insertion.h"
#include "tests/generator/run_command.h"
#include "tests/support/exits_with.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

class InsertCommand : public testing::Test {
 protected:
  /// Makes the recording and the plan.
  void Make(std::uint32_t num_frames) {
    MadeSequenceSpec made = RunWith("pcd", "");
    made.num_frames = num_frames;
    (void)MakeSequence(run(), made);
    (void)WriteRunPlan(folder_.path(), kBox);
  }

  [[nodiscard]] fs::path run() const { return folder_.path() / "run"; }
  [[nodiscard]] fs::path plan() const { return folder_.path() / "plan.json"; }
  [[nodiscard]] fs::path out() const { return folder_.path() / "out"; }
  [[nodiscard]] Ended Insert(const std::string& options) const {
    return Generate("insert " + run().string() + " " + plan().string() + " " + options + " 2>&1");
  }
  /// What it says of the recording before it begins.
  static constexpr const char* kRemark = "intensities: reflectances, 1 = white\n";

  TemporaryDirectory folder_;
};

TEST_F(InsertCommand, TellsWithCheckWhatThePlanMeetsAndWritesNothing) {
  Make(2);
  EXPECT_THAT(
      Insert("--check"),
      ExitsWith(0, testing::AllOf(testing::StartsWith(
                                      std::string(kRemark) +
                                      "crate:\n  at chainage 300 m, 0 m left, 0 m above the rails"),
                                  testing::HasSubstr("aimed at in 2 of 2 frames"))));
  EXPECT_FALSE(exists(out()));
}

TEST_F(InsertCommand, ChecksTheFramesThatAreWantedAndTakesNoOptionsForSpeed) {
  Make(3);
  EXPECT_THAT(Insert("--check --frames 1..1"),
              ExitsWith(0, testing::HasSubstr("aimed at in 1 of 1 frames")));
  EXPECT_EQ(Insert("--check --frames 1..3").said,
            std::string(kRemark) + "--frames: must be of the recording's 3 frames (got 1..3)\n");
  EXPECT_EQ(Insert("--check --out " + (run() / "x").string()).status, 1);
  EXPECT_EQ(Insert("--check --out " + out().string()).status, 0);
  EXPECT_FALSE(exists(out()));
  for (const std::string option : {"--certify 1%", "--threads 1"}) {
    const Ended refused = Insert("--check " + option);
    EXPECT_EQ(refused.status, 2) << option;
    EXPECT_NE(
        refused.said.find(option.substr(0, option.find(' ')) + ": must not come with --check"),
        std::string::npos)
        << refused.said;
  }
}

TEST_F(InsertCommand, WritesTheFramesThatAreWantedInTheFormatThatIsWanted) {
  Make(3);
  const Ended ended = Insert("--out " + out().string() + " --frames 1..2 --format ply");
  EXPECT_EQ(ended.status, 0) << ended.said;
  EXPECT_TRUE(ended.said.ends_with(" points in 2 frames\nwritten to " + out().string() + "\n"))
      << ended.said;
  EXPECT_FALSE(exists(out() / "recording/frames/000000.ply"));
  EXPECT_TRUE(exists(out() / "recording/frames/000001.ply"));
  EXPECT_TRUE(exists(out() / "recording/frames/000002.ply"));
  // Once more, it has nothing to do and says the same.
  EXPECT_EQ(Insert("--out " + out().string() + " --frames 1..2 --format ply").said, ended.said);
}

TEST_F(InsertCommand, SaysInOneLineWhatIsWrong) {
  Make(2);
  const auto expect = [&](const std::string& options, const std::string& said) {
    const Ended ended = Insert(options);
    EXPECT_EQ(ended.status, 1) << options;
    EXPECT_EQ(ended.said, said);
  };
  const std::string to_out = "--out " + out().string();
  expect("", "--out: missing (only --check writes nothing)\n");
  expect(to_out + " --frames 2..1",
         "--frames: must be numbers of frames, first and last, such as 12..30 (got 2..1)\n");
  expect(to_out + " --frames 0..2",
         std::string(kRemark) + "--frames: must be of the recording's 2 frames (got 0..2)\n");
  expect(
      "--out " + (run() / "more").string(),
      "--out: must not be in the recording's directory (got " + (run() / "more").string() + ")\n");
  fs::copy_file(run().string() + ".json", plan(), fs::copy_options::overwrite_existing);
  expect(to_out, plan().string() + ": /world/recording: missing\n" + plan().string() +
                     ": /vehicle: must be left out of a plan, whose world is a recording\n");
  EXPECT_FALSE(exists(out()));
}

// Where the sensor was is not known, so that nothing can be told of what it would have seen.
TEST_F(InsertCommand, RefusesPositionsOfANationalGrid) {
  const fs::path map = folder_.path() / "map.pcd";
  WriteFileWhole(
      map,
      "VERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\n"
      "POINTS 2\nDATA ascii\n494428.61 4877455.58 131.57\n494430.61 4877455.58 131.57\n");
  (void)WriteRunPlan(folder_.path(), "", R"({"poses": "standing"})");
  for (const std::string options : {"", " --points-alone", " --points-alone --format pcd"}) {
    const std::string command =
        "insert " + map.string() + " " + plan().string() + " --out " + out().string() + options;
    EXPECT_THAT(Generate(command + " 2>&1"),
                ExitsWith(1, testing::HasSubstr("map.pcd: must be in the axes of its sensor: its "
                                                "positions are map coordinates, and where the "
                                                "sensor was is not known\n")))
        << options;
    EXPECT_FALSE(exists(out())) << options;
  }
}

TEST_F(InsertCommand, LeavesNothingWhereThePlanDoesNotFitTheRecording) {
  Make(2);
  // The firings of a raster are not those of a spinning sensor.
  std::string text = ReadFileWhole(plan());
  text.replace(text.find("vir2rail"), std::string("vir2rail").size(), "vlp16");
  WriteFileWhole(plan(), text);
  EXPECT_THAT(Insert("--out " + out().string()),
              ExitsWith(1, testing::HasSubstr("000000.pcd: its firings cannot be found: ")));
  EXPECT_FALSE(exists(out()));
  // --check refuses what the run refuses, and takes what it takes.
  const std::string to_out = "--out " + out().string();
  EXPECT_EQ(Insert("--check").status, 1);
  EXPECT_EQ(Insert("--check").said, Insert(to_out).said);
  EXPECT_EQ(Insert("--check --points-alone").status, 0);
  EXPECT_EQ(Insert("--points-alone " + to_out).status, 0);
}

TEST_F(InsertCommand, KeepsTheFramesThatItHasWhereALaterOneCannotBeRead) {
  Make(16);
  fs::resize_file(run() / "frames/000015.pcd", 1000);
  EXPECT_THAT(Insert("--threads 1 --out " + out().string()),
              ExitsWith(1, testing::HasSubstr("000015.pcd: ")));
  EXPECT_TRUE(exists(out() / "recording/frames/000000.pcd"));
}

TEST_F(InsertCommand, StopsAfterAFrameOnCtrlCAndContinues) {
  Make(16);
  const pid_t child = ::fork();
  if (child == 0) {
    UseDefaultSignals();
    ::execl(RAILCAST_GENERATE, RAILCAST_GENERATE, "insert", run().c_str(), plan().c_str(), "--out",
            out().c_str(), "--threads", "1", nullptr);
    ::_exit(127);
  }
  while (!exists(out() / "added/000001.pcd") && ::waitpid(child, nullptr, WNOHANG) == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ::kill(child, SIGINT);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 130);
  EXPECT_FALSE(exists(out() / "manifest.json"));
  EXPECT_THAT(Insert("--out " + out().string()), ExitsWith(0));
  const fs::path whole = folder_.path() / "whole";
  EXPECT_EQ(Insert("--out " + whole.string()).status, 0);
  EXPECT_EQ(FilesOf(out()), FilesOf(whole));
}

}  // namespace
}  // namespace railcast
