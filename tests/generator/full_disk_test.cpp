#include <gtest/gtest.h>

#include <filesystem>

#include "core/io/write_file.h"
#include "generator/line_file.h"
#include "generator/run_sequence.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/small_disk.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/example_run.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

// Fills the disk, says what the run says, makes room and resumes.
std::string FillAndResume(const fs::path& disk) {
  const auto make_large = [](std::uint32_t index, Frame& frame, std::vector<ObjectInFrame>&) {
    frame = ExampleFrame(index, 20, 100);
  };
  WriteFileWhole(disk / "other", std::string(500'000, 'o'));
  const SequenceSpec spec = ExampleRun(disk / "run", "pcd", 8);
  std::string said = MessageOf([&] { (void)RunSequence(spec, make_large, NoHooks()); });
  for (const auto& entry : fs::recursive_directory_iterator(disk / "run")) {
    if (entry.path().extension() == ".part") said += " and left " + entry.path().string();
  }
  fs::remove(disk / "other");
  const auto resumed = RunSequence(spec, make_large, NoHooks());
  said += resumed.is_complete && resumed.num_resumed > 0 ? "|resumed" : "|not resumed";
  return said;
}

TEST(FullDisk, GivesOneClearLineAndARunThatCanBeResumed) {
  const TemporaryDirectory directory;
  const auto result = RunOnSmallDisk(directory.path(), FillAndResume);
  if (!result.was_run) GTEST_SKIP() << "no mount namespace here: a tmpfs cannot be mounted";
  const std::string place = (directory.path() / "run").string() + "/";
  EXPECT_EQ(result.said.substr(0, place.size()), place);
  const std::string end = ": no space left on device|resumed";
  ASSERT_GT(result.said.size(), end.size());
  EXPECT_EQ(result.said.substr(result.said.size() - end.size()), end);
  EXPECT_EQ(result.said.find('\n'), std::string::npos);
}

TEST(FullDisk, TakesNoPartOfALine) {
  const TemporaryDirectory directory;
  const auto result = RunOnSmallDisk(directory.path(), [](const fs::path& disk) {
    LineFile file(disk / "lines", 0);
    file.Append("first\n");
    const std::string said = MessageOf([&] { file.Append(std::string(2'000'000, 'x')); });
    file.Append("second\n");
    return said + "|" + ReadFileWhole(disk / "lines");
  });
  if (!result.was_run) GTEST_SKIP() << "no mount namespace here: a tmpfs cannot be mounted";
  EXPECT_EQ(result.said,
            (directory.path() / "lines").string() + ": no space left on device|first\nsecond\n");
}

}  // namespace
}  // namespace railcast
