#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/io/write_file.h"
#include "tests/analysis/analyze_program.h"
#include "tests/core/io/damage.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/project_folder.h"

namespace railcast {
namespace {

TEST(VerifyCommand, SaysALineForEveryFaultAndEndsWithOne) {
  for (const std::string format : {"pcd", "kitti"}) {
    const TemporaryDirectory directory;
    const std::string scenario = MakeProject(directory.path() / "project").string();
    const auto out = directory.path() / "out";
    ASSERT_EQ(RunCommand(RAILCAST_GENERATE " sequence " + scenario + " --frames 2 --out " +
                         out.string() + " --format " + format)
                  .status,
              0);
    const Ended whole = Analyze("verify " + out.string());
    EXPECT_EQ(whole.status, 0) << whole.said;
    EXPECT_THAT(whole.said, testing::StartsWith(out.string() + ": whole; read 2 frames in "));
    const auto file =
        out / (format == "kitti" ? "sequences/00/velodyne/000001.bin" : "frames/000001.pcd");
    const std::string bytes = ReadFileWhole(file);
    WriteFileWhole(file, Flipped(bytes, bytes.size() - 5));
    WriteFileWhole(out / "letter.txt", "dear");
    const Ended damaged = Analyze("verify " + out.string());
    EXPECT_EQ(damaged.status, 1);
    EXPECT_THAT(damaged.said,
                testing::MatchesRegex(file.string() +
                                      ": must have the hash [0-9a-f]+, as frames.jsonl "
                                      "says \\(got [0-9a-f]+\\)\n" +
                                      out.string() +
                                      "/letter.txt: is named neither in manifest.json nor in "
                                      "frames.jsonl\n" +
                                      out.string() +
                                      ": 2 faults; read 2 frames in [0-9]+ files, "
                                      "[0-9.]+ MB\n"));
    // The message that every reader of sequences gives.
    const Ended read = Analyze("stats " + out.string() + " --format text");
    EXPECT_EQ(read.status, 1);
    EXPECT_THAT(read.said, testing::StartsWith(file.string() + ": must have the hash "));
  }
}

TEST(VerifyCommand, KnowsTheImagesOfACamera) {
  for (const std::string format : {"pcd", "kitti"}) {
    const TemporaryDirectory directory;
    (void)MakeProject(directory.path() / "project");
    const auto scenario = directory.path() / "project/camera.json";
    WriteFileWhole(scenario, R"({
      "version": 1,
      "file": "scenario.json",
      "camera": {"name": "front", "width_px": 40, "height_px": 30, "horizontal_fov_deg": 60,
                 "rate_hz": 5}
    })");
    const auto out = directory.path() / "out";
    const Ended made = RunCommand(RAILCAST_GENERATE " sequence " + scenario.string() +
                                  " --frames 3 --out " + out.string() + " --format " + format);
    ASSERT_EQ(made.status, 0) << made.said;
    const Ended whole = Analyze("verify " + out.string());
    EXPECT_EQ(whole.status, 0) << whole.said;
    // Every second frame has an image, whatever number its files have.
    EXPECT_TRUE(std::filesystem::exists(out / "camera/front/depth/000002.npy"));
    EXPECT_FALSE(std::filesystem::exists(out / "camera/front/depth/000001.npy"));
    // Reports on clouds are not concerned.
    EXPECT_EQ(Analyze("stats " + out.string() + " --format text").status, 0);
    const auto image = out / "camera/front/label/000002.png";
    std::filesystem::remove(image);
    const Ended damaged = Analyze("verify " + out.string());
    EXPECT_EQ(damaged.status, 1);
    EXPECT_THAT(damaged.said, testing::StartsWith(image.string() + ": no such file"));
  }
}

TEST(VerifyCommand, WantsADirectoryOfASequence) {
  EXPECT_EQ(Analyze("verify").status, 2);
  const TemporaryDirectory directory;
  const Ended run = Analyze("verify " + directory.path().string());
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.said, directory.path().string() + "/run.json: no such file or directory\n");
}

}  // namespace
}  // namespace railcast
