#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/io/write_file.h"
#include "generator/extras/insert/plan/recorded_run.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// Whether the traits of a recording change with a file of it that keeps its size.
bool ChangesWith(const fs::path& recording, const fs::path& file) {
  const std::string before = RecordingTraits(recording);
  std::string bytes = ReadFileWhole(file);
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  WriteFileWhole(file, bytes);
  return RecordingTraits(recording) != before;
}

TEST(RecordingTraits, ChangeWithTheContentOfEveryFileThatIsRead) {
  const TemporaryDirectory folder;
  const auto write = [&](const char* name) {
    const fs::path file = folder.path() / name;
    fs::create_directories(file.parent_path());
    WriteFileWhole(file, "content");
    return file;
  };
  const fs::path clouds = write("clouds/0.pcd").parent_path();
  EXPECT_TRUE(ChangesWith(clouds, write("clouds/1.pcd")));
  EXPECT_TRUE(ChangesWith(clouds, write("clouds/frames.csv")));
  EXPECT_TRUE(ChangesWith(clouds / "0.pcd", clouds / "0.pcd"));
  const fs::path capture = write("drive.pcap");
  EXPECT_TRUE(ChangesWith(capture, capture));
  EXPECT_TRUE(ChangesWith(capture, write("drive.dat")));
  const fs::path velodyne = write("sequences/00/velodyne/0.bin").parent_path();
  EXPECT_TRUE(ChangesWith(velodyne, velodyne / "0.bin"));
  EXPECT_TRUE(ChangesWith(velodyne, write("sequences/00/labels/0.label")));
  EXPECT_TRUE(ChangesWith(velodyne, write("sequences/00/poses.txt")));
  EXPECT_TRUE(ChangesWith(velodyne / "0.bin", velodyne / "../labels/0.label"));
  EXPECT_FALSE(ChangesWith(clouds, capture));
}

TEST(RecordingTraits, OfASequenceAreItsManifest) {
  const TemporaryDirectory folder;
  const fs::path run = folder.path() / "run";
  fs::create_directories(run);
  for (const char* const name : {"frames.jsonl", "manifest.json"}) {
    WriteFileWhole(run / name, "content");
  }
  EXPECT_TRUE(ChangesWith(run, run / "manifest.json"));
  // Frames are compared with the hashes that it covers where they are read.
  EXPECT_FALSE(ChangesWith(run, run / "frames.jsonl"));
  fs::remove(run / "manifest.json");
  EXPECT_TRUE(ChangesWith(run, run / "frames.jsonl"));
}

}  // namespace
}  // namespace railcast
