#include "core/io/write_file.h"

#include <gtest/gtest.h>

#include "tests/core/io/message_of.h"
#include "tests/core/io/small_disk.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

TEST(WriteFileWhole, ReplacesTheFileAndLeavesNothingBeside) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "frame";
  WriteFileWhole(file, "first, and longer");
  WriteFileWhole(file, "second");
  EXPECT_EQ(ReadFileWhole(file), "second");
  EXPECT_FALSE(std::filesystem::exists(file.string() + ".part"));
}

TEST(WriteFileWhole, SaysWhatTheSystemSaid) {
  EXPECT_EQ(MessageOf([] { WriteFileWhole("/no/such/place/a.pcd", "x"); }),
            "/no/such/place/a.pcd: no such file or directory");
  EXPECT_EQ(MessageOf([] { (void)ReadFileWhole("/no/such/place/a.pcd"); }),
            "/no/such/place/a.pcd: no such file or directory");
}

TEST(WriteFileWhole, LeavesNothingOnAFullDisk) {
  const TemporaryDirectory directory;
  const auto result = RunOnSmallDisk(directory.path(), [](const std::filesystem::path& disk) {
    WriteFileWhole(disk / "a.pcd", std::string(300'000, 'a'));
    std::string said =
        MessageOf([&] { WriteFileWhole(disk / "a.pcd", std::string(2'000'000, 'b')); });
    for (const auto& entry : std::filesystem::directory_iterator(disk)) {
      said += '|';
      said += entry.path().filename().string();
      said += ' ';
      said += std::to_string(entry.file_size());
    }
    return said;
  });
  if (!result.refused.empty()) GTEST_SKIP() << result.refused;
  EXPECT_EQ(result.said,
            (directory.path() / "a.pcd").string() + ": no space left on device|a.pcd 300000");
}

}  // namespace
}  // namespace railcast
