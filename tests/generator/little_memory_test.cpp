#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>

#include "core/io/write_file.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/project_folder.h"
#include "tests/generator/run_command.h"
#include "tests/support/memory_limit.h"

namespace railcast {
namespace {

using testing::ContainsRegex;

// Returns a wall of 180,000 triangles, 6 m x 4 m, to replace the project's rock.
std::string WallObj() {
  constexpr int kNumSteps = 300;
  std::ostringstream obj;
  for (int i = 0; i <= kNumSteps; ++i) {
    for (int j = 0; j <= kNumSteps; ++j) {
      obj << "v 0 " << 6.0 * j / kNumSteps - 3.0 << ' ' << 4.0 * i / kNumSteps << '\n';
    }
  }
  for (int i = 0; i < kNumSteps; ++i) {
    for (int j = 0; j < kNumSteps; ++j) {
      const int a = i * (kNumSteps + 1) + j + 1;
      const int b = a + kNumSteps + 1;
      obj << "f " << a << ' ' << a + 1 << ' ' << b + 1 << ' ' << b << '\n';
    }
  }
  return obj.str();
}

TEST(LittleMemory, MakesTheSameFramesOrSaysWhatDidNotFit) {
  if (!kCanLimitMemory) GTEST_SKIP() << "sanitizers reserve more than can be limited";
  const TemporaryDirectory directory;
  const std::string scenario = MakeProject(directory.path() / "project").string();
  WriteFileWhole(directory.path() / "project/rock.obj", WallObj());
  const auto sequence = [&](const std::string& out) {
    return "sequence " + scenario + " --frames 2 --threads 2 --out " + out;
  };
  const std::string whole = (directory.path() / "whole").string();
  ASSERT_EQ(Generate(sequence(whole)).status, 0);
  const std::string manifest = ReadFileWhole(whole + "/manifest.json");

  std::set<std::string> said;
  std::size_t num_made = 0;
  constexpr int kLibraries_mb = 60;
  for (int limit_mb = kLibraries_mb; limit_mb < 640; limit_mb += num_made == 0 ? 8 : 160) {
    const std::string out = (directory.path() / std::to_string(limit_mb)).string();
    const Ended run = RunCommand("ulimit -v " + std::to_string(limit_mb * 1024) + "; " +
                                 RAILCAST_GENERATE + " " + sequence(out));
    if (run.said.find("loading shared libraries") != std::string::npos) continue;
    if (run.status == 0) {
      ++num_made;
      EXPECT_EQ(ReadFileWhole(out + "/manifest.json"), manifest) << limit_mb;
      continue;
    }
    said.insert(run.said);
    EXPECT_EQ(run.status, 1) << limit_mb << ": " << run.said;
    EXPECT_EQ(std::count(run.said.begin(), run.said.end(), '\n'), 1) << run.said;
    EXPECT_THAT(run.said, ContainsRegex("out of memory|no (further )?thread can be started"));
    EXPECT_FALSE(std::filesystem::exists(out + "/manifest.json"));
  }
  EXPECT_GT(num_made, 0U);
  // Which model or part of the line fails depends on the machine's libraries.
  EXPECT_THAT(said, testing::Contains(testing::HasSubstr("out of memory while building ")));
}

}  // namespace
}  // namespace railcast
