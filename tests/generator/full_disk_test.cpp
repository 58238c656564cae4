#include <gtest/gtest.h>
#include <sys/statvfs.h>

#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "core/base/error.h"
#include "core/io/run/run_folder.h"
#include "core/io/write_file.h"
#include "generator/run/make_frames.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/small_disk.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/example_run.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

using Files = std::map<std::string, std::string>;

std::uint64_t FreeBlocks(const fs::path& disk) {
  struct statvfs status {};
  Check(::statvfs(disk.c_str(), &status) == 0, "the disk is there");
  return status.f_bavail;
}

// Fills the disk except for `num_free` blocks.
void Fill(const fs::path& disk, std::uint64_t num_free) {
  struct statvfs status {};
  Check(::statvfs(disk.c_str(), &status) == 0, "the disk is there");
  WriteFileWhole(disk / "other", std::string((status.f_bavail - num_free) * status.f_frsize, 'o'));
  Check(FreeBlocks(disk) == num_free, "a file takes the blocks of its bytes");
}

// Returns what is wrong after a run finds room again and is resumed; empty if nothing is.
std::string Resume(const SequenceSpec& spec, const Files& undisturbed) {
  std::string fault;
  for (const auto& [name, bytes] : Contents(spec.directory)) {
    if (name.ends_with(kUnfinishedSuffix)) fault += ", left " + name;
  }
  if (!RunSequence(spec, MakeExampleFrame, NoHooks()).is_complete) fault += ", did not resume";
  if (Contents(spec.directory) != undisturbed) fault += ", resumed to other bytes";
  return fault;
}

// Repeats a run, each time with one more free block, until it fits. Returns a line for each run
// that did not: its error without the directory, and what was wrong afterwards.
std::string RunWithEveryRoom(const SequenceSpec& spec, const Files& undisturbed) {
  const fs::path disk = spec.directory.parent_path();
  const std::uint64_t num_blocks = FreeBlocks(disk);
  const std::string place = spec.directory.string() + "/";
  std::string lines;
  for (std::uint64_t num_free = 0; num_free <= num_blocks; ++num_free) {
    Fill(disk, num_free);
    const FramesAtOnce at_once = AtOnce(1 + num_free % 4);
    std::string said =
        MessageOf([&] { (void)RunSequence(spec, MakeExampleFrame, NoHooks(), {}, at_once); });
    if (said == "no error") return lines;
    if (said.starts_with(place)) said.erase(0, place.size());
    fs::remove(disk / "other");
    lines += said + Resume(spec, undisturbed) + "\n";
    fs::remove_all(spec.directory);
  }
  return lines + "no run fits\n";
}

class FullDisk : public testing::TestWithParam<const char*> {};

TEST_P(FullDisk, GivesOneClearLineAndARunThatCanBeResumedWhateverFileItHits) {
  const TemporaryDirectory directory;
  const SequenceSpec spec = ExampleRun(directory.path() / "run", GetParam());
  (void)RunSequence(spec, MakeExampleFrame, NoHooks());
  const Files undisturbed = Contents(spec.directory);
  fs::remove_all(spec.directory);
  const auto result = RunOnSmallDisk(
      directory.path(), [&](const fs::path&) { return RunWithEveryRoom(spec, undisturbed); });
  if (!result.refused.empty()) GTEST_SKIP() << result.refused;
  std::set<std::string> expected;
  for (const auto& [name, bytes] : undisturbed) expected.insert(name + ": no space left on device");
  std::istringstream lines(result.said);
  std::set<std::string> said;
  for (std::string line; std::getline(lines, line);) said.insert(line);
  EXPECT_EQ(said, expected);
}

INSTANTIATE_TEST_SUITE_P(Formats, FullDisk, testing::Values("pcd", "ply", "kitti"));

TEST(LineFile, TakesNoPartOfALineOnAFullDisk) {
  const TemporaryDirectory directory;
  const auto result = RunOnSmallDisk(directory.path(), [](const fs::path& disk) {
    LineFile file(disk / "lines", 0);
    file.Append("first\n");
    const std::string said = MessageOf([&] { file.Append(std::string(2'000'000, 'x')); });
    file.Append("second\n");
    return said + "|" + ReadFileWhole(disk / "lines");
  });
  if (!result.refused.empty()) GTEST_SKIP() << result.refused;
  EXPECT_EQ(result.said,
            (directory.path() / "lines").string() + ": no space left on device|first\nsecond\n");
}

}  // namespace
}  // namespace railcast
