#include "core/base/input_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

std::string Opening(const std::filesystem::path& file) {
  return MessageOf([&] { static_cast<void>(OpenInput(file)); });
}

TEST(OpenInput, ReadsRegularFilesAndWhatLinksToThem) {
  const TemporaryDirectory directory;
  std::ofstream(directory.path() / "a") << "text";
  std::filesystem::create_symlink("a", directory.path() / "link");
  for (const char* name : {"a", "link"}) {
    std::ifstream stream = OpenInput(directory.path() / name);
    std::string word;
    stream >> word;
    EXPECT_EQ(word, "text");
  }
}

// Opening the FIFO would wait for a writer indefinitely.
TEST(OpenInput, WaitsForNothing) {
  const TemporaryDirectory directory;
  const std::string fifo = (directory.path() / "fifo").string();
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  std::filesystem::create_symlink("fifo", directory.path() / "link");
  EXPECT_EQ(Opening(fifo), fifo + ": must be a regular file (got a FIFO)");
  const std::string link = (directory.path() / "link").string();
  EXPECT_EQ(Opening(link), link + ": must be a regular file (got a FIFO)");
  EXPECT_EQ(Opening("/dev/zero"), "/dev/zero: must be a regular file (got a character device)");
  EXPECT_EQ(Opening("/"), "/: must be a regular file (got a directory)");
}

TEST(OpenInput, SaysWhyAFileCannotBeRead) {
  EXPECT_EQ(Opening("/no/such/file"), "/no/such/file: no such file or directory");
  const TemporaryDirectory directory;
  const std::filesystem::path loop = directory.path() / "loop";
  std::filesystem::create_symlink("loop", loop);
  EXPECT_EQ(Opening(loop), loop.string() + ": too many levels of symbolic links");
}

TEST(ReadFileWhole, GivesTheBytesAsTheyAre) {
  const TemporaryDirectory directory;
  const std::filesystem::path file = directory.path() / "a";
  for (const std::string& bytes : {std::string(), std::string("a\r\n\0\x1a\xff\n", 8)}) {
    std::ofstream(file, std::ios::binary) << bytes;
    EXPECT_EQ(ReadFileWhole(file), bytes);
  }
}

TEST(ReadFileWhole, SaysWhyItCannot) {
  EXPECT_EQ(MessageOf([] { static_cast<void>(ReadFileWhole("/")); }),
            "/: must be a regular file (got a directory)");
  EXPECT_EQ(MessageOf([] { static_cast<void>(ReadFileWhole("/no/such/file")); }),
            "/no/such/file: no such file or directory");
}

TEST(FileError, StaysOneLineWhateverTheFileIsCalled) {
  EXPECT_STREQ(FileError("a\nb\x1b[2J\xff", ENOENT).what(),
               "a\\nb\\u001b[2J\\xff: no such file or directory");
}

}  // namespace
}  // namespace railcast
