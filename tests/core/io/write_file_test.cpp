#include "core/io/write_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "core/base/inputs.h"
#include "core/io/run/run_folder.h"
#include "core/io/unfinished_file.h"
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

TEST(WriteFileWhole, ReplacesNothingButARegularFile) {
  const TemporaryDirectory directory;
  const std::string fifo = (directory.path() / "a.part").string();
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  std::filesystem::create_symlink("a.part", directory.path() / "link");
  std::filesystem::create_directory(directory.path() / "folder");
  const std::string place = directory.path().string() + "/";
  const auto said = [&](const char* file) {
    return MessageOf([&] { WriteFileWhole(place + file, "x"); });
  };
  EXPECT_EQ(said("a.part"), place + "a.part: must be a regular file (got a FIFO)");
  EXPECT_EQ(said("link"), place + "link: must be a regular file (got a symbolic link)");
  EXPECT_EQ(said("a"), place + "a.part: must be a regular file (got a FIFO)");
  EXPECT_EQ(said("folder"), place + "folder: must be a regular file (got a directory)");
  EXPECT_TRUE(std::filesystem::is_fifo(fifo));
  EXPECT_TRUE(std::filesystem::is_symlink(directory.path() / "link"));
}

// Of a link that stands where the file or the unfinished one is written, whether it leads to a file
// or nowhere yet.
TEST(WriteFileWhole, FollowsNoLinkAndNeitherDoFilesThatGrow) {
  for (const std::string target : {"mine", "nothing"}) {
    for (const std::string name : {"frame", "frame.part"}) {
      const TemporaryDirectory directory;
      const auto file = directory.path() / "frame";
      WriteNamedFile(directory.path() / "mine", "mine");
      std::filesystem::create_symlink(target, directory.path() / name);
      const std::string refusal =
          (directory.path() / name).string() + ": must be a regular file (got a symbolic link)";
      EXPECT_EQ(MessageOf([&] { WriteFileWhole(file, "x"); }), refusal);
      EXPECT_EQ(MessageOf([&] { const UnfinishedFile grows(file, 0); }), refusal);
      EXPECT_EQ(MessageOf([&] { const LineFile lines(file, 0); }), refusal);
      EXPECT_EQ(ReadFileWhole(directory.path() / "mine"), "mine");
      EXPECT_FALSE(std::filesystem::exists(directory.path() / "nothing"));
    }
  }
}

TEST(WriteNamedFile, WritesWhatASymbolicLinkLeadsTo) {
  const TemporaryDirectory directory;
  const auto path = [&](const char* name) { return directory.path() / name; };
  std::filesystem::create_directory(path("folder"));
  std::filesystem::create_symlink("folder/file", path("link"));
  std::filesystem::create_symlink(path("link"), path("link_to_link"));
  for (const char* name : {"link", "link_to_link", "folder/file"}) {
    WriteNamedFile(path(name), name);
    EXPECT_EQ(ReadFileWhole(path("folder/file")), name);
    EXPECT_TRUE(std::filesystem::is_symlink(path("link")));
    EXPECT_TRUE(std::filesystem::is_symlink(path("link_to_link")));
  }
  EXPECT_FALSE(std::filesystem::exists(path("link.part")));
  std::filesystem::create_symlink("circle", path("circle"));
  EXPECT_EQ(MessageOf([&] { WriteNamedFile(path("circle"), "x"); }),
            path("circle").string() + ": too many levels of symbolic links");
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

TEST(WriteNamedFile, DoesNotReplaceAnInputByAnyName) {
  const Inputs inputs;
  const TemporaryDirectory directory;
  const std::filesystem::path read = directory.path() / "rock.obj";
  const std::filesystem::path noted = directory.path() / "scenario.json";
  WriteFileWhole(read, "v 0 0 0");
  WriteFileWhole(noted, "{}");
  static_cast<void>(ReadInput(read));
  NoteInput(noted);
  EXPECT_NO_THROW(WriteNamedFile(directory.path() / "other.json", "written"));
  const std::filesystem::path link = directory.path() / "link.json";
  std::filesystem::create_symlink(read, link);
  const std::filesystem::path twin = directory.path() / "twin.json";
  std::filesystem::create_hard_link(noted, twin);
  for (const std::filesystem::path& file :
       {read, noted, link, twin, directory.path() / "." / "rock.obj"}) {
    EXPECT_THAT(MessageOf([&] { WriteNamedFile(file, "written"); }),
                testing::EndsWith(" must not be written over, since this command reads it"))
        << file;
    EXPECT_THROW(CheckCanWrite(file), InputError) << file;
  }
  EXPECT_EQ(ReadFileWhole(read), "v 0 0 0");
  EXPECT_EQ(ReadFileWhole(noted), "{}");
}

}  // namespace
}  // namespace railcast
