#include "railcast/io/recording.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/damaged_run.h"
#include "tests/core/io/recording/read_all.h"

namespace railcast {
namespace {

/// Returns the error of reading the run, without the folder's name.
std::string RunMessage(const DamagedRun& run) {
  std::string message = MessageOf([&] { (void)ReadAll(run.path); });
  const std::string place = run.path.string() + "/";
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  return message.starts_with(place) ? message.substr(place.size()) : message;
}

TEST(SequenceCheck, NoticesAFlippedBitInAFrame) {
  const std::vector<std::pair<const char*, const char*>> frames = {
      {"pcd", "frames/000001.pcd"},
      {"pcd-compressed", "frames/000001.pcd"},
      {"ply", "frames/000001.ply"},
      {"kitti", "sequences/00/velodyne/000001.bin"},
      {"kitti", "sequences/00/labels/000001.label"}};
  for (const auto& [format, file] : frames) {
    const DamagedRun run(format);
    const std::string before = run.HashOf(file);
    run.Flip(file);
    EXPECT_EQ(RunMessage(run), std::string(file) + ": must have the hash " + before +
                                   ", as frames.jsonl says (got " + run.HashOf(file) + ")");
  }
}

TEST(SequenceCheck, NoticesAFrameThatIsCutShort) {
  const DamagedRun run("pcd");
  const auto file = run.path / "frames/000001.pcd";
  const std::string size = std::to_string(std::filesystem::file_size(file));
  std::filesystem::resize_file(file, 1000);
  EXPECT_EQ(RunMessage(run),
            "frames/000001.pcd: must have " + size + " bytes, as frames.jsonl says (got 1000)");
}

TEST(SequenceCheck, NoticesAFlippedBitInWhateverElseItReads) {
  for (const char* format : {"pcd", "kitti"}) {
    const DamagedRun run(format);
    for (const char* file : {"scenario.resolved.json", "labels.json", "materials.json",
                             "objects.jsonl", "poses.csv", "frames.jsonl", "run.json"}) {
      const std::string whole = ReadFileWhole(run.path / file);
      run.Flip(file);
      const std::string rule = std::string(file) + ": must have the hash " + ContentHash(whole) +
                               ", as manifest.json says (got " + run.HashOf(file) + ")";
      // A damaged run.json may be refused before its hash is checked, because it must be parsed
      // first.
      const std::string got = RunMessage(run);
      EXPECT_TRUE(got == rule || got.starts_with("run.json: ")) << got;
      WriteFileWhole(run.path / file, whole);
    }
    EXPECT_EQ(RunMessage(run), "no error");
  }
}

TEST(SequenceCheck, NoticesAMissingLine) {
  const DamagedRun run("kitti", 3);
  for (const char* file : {"frames.jsonl", "objects.jsonl", "poses.csv", "sequences/00/poses.txt",
                           "sequences/00/times.txt"}) {
    const std::string whole = ReadFileWhole(run.path / file);
    for (const std::size_t line : {1U, 2U}) {
      run.Cut(file, line);
      EXPECT_EQ(RunMessage(run),
                std::string(file) + ": must have a line for each of 3 frames (got 2)");
      WriteFileWhole(run.path / file, whole);
    }
  }
  // Without a manifest the last line may be missing, but no earlier one.
  std::filesystem::remove(run.path / "manifest.json");
  run.Cut("frames.jsonl", 1);
  EXPECT_EQ(RunMessage(run), "frames.jsonl:2: frame: must be 1, one after another (got 2)");
}

TEST(SequenceCheck, OfAnInterruptedRunGoesAsFarAsTheRun) {
  const DamagedRun run("pcd", 3);
  std::filesystem::remove(run.path / "manifest.json");
  EXPECT_EQ(RunMessage(run), "no error");
  const std::string objects = ReadFileWhole(run.path / "objects.jsonl");
  WriteFileWhole(run.path / "objects.jsonl", Replaced(objects, "\"points\":8", "\"points\":9"));
  EXPECT_TRUE(RunMessage(run).starts_with(
      "frames.jsonl:2: records_xxh3: must be that of the frame's lines in poses.csv:3, "
      "objects.jsonl:2, "))
      << RunMessage(run);
  WriteFileWhole(run.path / "objects.jsonl", objects);
  const std::string scenario = ReadFileWhole(run.path / "scenario.resolved.json");
  WriteFileWhole(run.path / "scenario.resolved.json", scenario + " ");
  EXPECT_EQ(RunMessage(run), "scenario.resolved.json: must have the hash " + ContentHash(scenario) +
                                 ", as run.json says (got " + ContentHash(scenario + " ") + ")");
}

TEST(SequenceCheck, OfAnInterruptedRunComparesNamesWithTheScenario) {
  const DamagedRun run("pcd");
  std::filesystem::remove(run.path / "manifest.json");
  for (const char* file : {"labels.json", "materials.json"}) {
    const std::string whole = ReadFileWhole(run.path / file);
    WriteFileWhole(run.path / file, Replaced(whole, "\"ballast\"", "\"gravel\""));
    EXPECT_EQ(RunMessage(run), std::string(file) + ": must agree with scenario.resolved.json");
    WriteFileWhole(run.path / file, whole);
  }
}

TEST(SequenceCheck, TakesNoSequenceForMereCloudsWhenItsLinesAreLost) {
  for (const char* format : {"pcd", "kitti"}) {
    const DamagedRun run(format);
    std::filesystem::remove(run.path / "frames.jsonl");
    EXPECT_EQ(RunMessage(run), "frames.jsonl: no such file or directory");
  }
}

}  // namespace
}  // namespace railcast
