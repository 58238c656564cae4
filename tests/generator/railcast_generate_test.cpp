#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <thread>

#include "core/io/pcd_reader.h"
#include "core/io/ply_reader.h"
#include "core/io/write_file.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/example_run.h"

namespace railcast {
namespace {

const std::string scenarios = std::string(RAILCAST_SOURCE_DIR) + "/scenarios/";

struct Ended {
  int status{};
  std::string said;  // On stdout and stderr together.
};

Ended Generate(const std::string& arguments) {
  const std::string command = std::string(RAILCAST_GENERATE) + " " + arguments + " 2>&1";
  FILE* pipe = ::popen(command.c_str(), "r");
  Ended run;
  std::array<char, 4096> buffer{};
  std::size_t count = 0;
  while ((count = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0) {
    run.said.append(buffer.data(), count);
  }
  run.status = WEXITSTATUS(::pclose(pipe));
  return run;
}

TEST(RailcastGenerate, ExplainsItself) {
  EXPECT_EQ(Generate("--version").said, "railcast " RAILCAST_VERSION "\n");
  for (const char* command : {"", "sequence ", "check ", "world ", "trace "}) {
    const Ended run = Generate(std::string(command) + "--help");
    EXPECT_EQ(run.status, 0);
    EXPECT_NE(run.said.find("Usage:"), std::string::npos);
  }
}

TEST(RailcastGenerate, ExitsWithTwoOnWrongUsage) {
  EXPECT_EQ(Generate("").status, 2);
  EXPECT_EQ(Generate("sequence").status, 2);
  EXPECT_EQ(Generate("dance").status, 2);
  EXPECT_EQ(Generate("sequence a.json --out b --format las").status, 2);
  EXPECT_EQ(Generate("sequence a.json --out b --frames 0").status, 2);
  EXPECT_EQ(Generate("sequence a.json --out b --fidelity best").status, 2);
}

TEST(RailcastGenerate, ReplaysOneFiringEffectByEffect) {
  const Ended run = Generate("trace " + scenarios + "minimal.json --frame 3 --firing 0");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.said.find("frame 3 firing 0 at 0 ns, slot 0\n"), 0U);
  for (const char* effect : {"\nhit ", "\nthreshold ", "\nnoise "}) {
    EXPECT_NE(run.said.find(effect), std::string::npos) << effect;
  }
  const Ended beyond = Generate("trace " + scenarios + "minimal.json --firing 28800");
  EXPECT_EQ(beyond.status, 1);
  EXPECT_EQ(beyond.said, "--firing: must be < 28800, the firings of a frame (got 28800)\n");
}

TEST(RailcastGenerate, ExitsWithOneAndOneLineOnBadInput) {
  const TemporaryDirectory directory;
  const std::string out = " --out " + directory.path().string();
  const Ended missing = Generate("sequence /no/such.json" + out);
  EXPECT_EQ(missing.status, 1);
  EXPECT_EQ(missing.said, "/no/such.json: no such file\n");
  const Ended fields = Generate("sequence " + scenarios + "minimal.json --fields labl" + out);
  EXPECT_EQ(fields.status, 1);
  EXPECT_EQ(fields.said.find("--fields: unknown field \"labl\", nearest is \"label\""), 0U);
  const Ended world = Generate("world " + scenarios + "minimal.json --out a.stl");
  EXPECT_EQ(world.status, 1);
  EXPECT_EQ(world.said, "--out: must end in .ply or .obj (got a.stl)\n");
  const Ended stretch =
      Generate("world " + scenarios + "minimal.json --from-s 5 --to-s 1 --out a.ply");
  EXPECT_EQ(stretch.said, "--from-s, --to-s: must be 0 <= from < to <= 1000 (got 5, 1)\n");
}

TEST(RailcastGenerate, GivesTheSameBytesForAnyNumberOfThreads) {
  const TemporaryDirectory directory;
  const std::string command =
      "sequence " + scenarios + "minimal.json --frames 2 --out " + directory.path().string() + "/";
  for (const char* threads : {"1", "2", "8"}) {
    const Ended run = Generate(command + threads + " --threads " + threads);
    EXPECT_EQ(run.status, 0) << run.said;
    EXPECT_NE(run.said.find("2 of 2 frames in "), std::string::npos);
  }
  const auto one = Contents(directory.path() / "1");
  EXPECT_EQ(Contents(directory.path() / "2"), one);
  EXPECT_EQ(Contents(directory.path() / "8"), one);
  const auto cloud = ReadPcd(directory.path() / "1/frames/000000.pcd");
  EXPECT_EQ(cloud.width, 240U);
  EXPECT_EQ(cloud.height, 120U);
}

TEST(RailcastGenerate, StartsAtAnyFrame) {
  const TemporaryDirectory directory;
  const std::string command =
      "sequence " + scenarios + "st_gallen_approach.json --out " + directory.path().string() + "/";
  ASSERT_EQ(Generate(command + "all --frames 3").status, 0);
  ASSERT_EQ(Generate(command + "last --frames 1 --start-frame 2").status, 0);
  EXPECT_EQ(ReadFileWhole(directory.path() / "all/frames/000002.pcd"),
            ReadFileWhole(directory.path() / "last/frames/000002.pcd"));
}

TEST(RailcastGenerate, StopsAfterAFrameOnCtrlCAndContinues) {
  const TemporaryDirectory directory;
  const std::string out = (directory.path() / "run").string();
  const std::string file = scenarios + "minimal.json";
  const pid_t child = ::fork();
  if (child == 0) {
    ::execl(RAILCAST_GENERATE, RAILCAST_GENERATE, "sequence", file.c_str(), "--out", out.c_str(),
            "--frames", "100000", "--fields", "x,y,z", nullptr);
    ::_exit(127);
  }
  while (!std::filesystem::exists(out + "/frames/000001.pcd")) {
    ASSERT_EQ(::waitpid(child, nullptr, WNOHANG), 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ::kill(child, SIGINT);
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  const auto contents = Contents(out);
  EXPECT_FALSE(contents.contains("manifest.json"));
  for (const auto& [name, bytes] : contents)
    EXPECT_EQ(name.find(".part"), std::string::npos) << name;
}

TEST(RailcastGenerate, ChecksAScenario) {
  const Ended run = Generate("check " + scenarios + "st_gallen_approach.json");
  EXPECT_EQ(run.status, 0);
  for (const char* text :
       {"28800 firings a frame (120 rows x 240 columns)", "at most 288000 points/s",
        "7 curvature jumps smoothed", "152 gradient steps smoothed", "(-v lists them)",
        "foul_wagon: open_wagon, label wagon"}) {
    EXPECT_NE(run.said.find(text), std::string::npos) << text;
  }
  EXPECT_EQ(run.said.find("curvature at s "), std::string::npos);
  const Ended verbose = Generate("check -v " + scenarios + "st_gallen_approach.json");
  EXPECT_NE(verbose.said.find("curvature at s "), std::string::npos);
}

TEST(RailcastGenerate, PrintsAResolvedScenarioThatReadsBackTheSame) {
  const TemporaryDirectory directory;
  const std::string file = (directory.path() / "resolved.json").string();
  const Ended first = Generate("check " + scenarios + "minimal.json --resolved -");
  EXPECT_EQ(first.status, 0);
  EXPECT_EQ(Generate("check " + scenarios + "minimal.json --resolved " + file).status, 0);
  EXPECT_EQ(ReadFileWhole(file), first.said);
  EXPECT_EQ(Generate("check " + file + " --resolved -").said, first.said);
}

TEST(RailcastGenerate, WritesTheSceneAsAMesh) {
  const TemporaryDirectory directory;
  const std::string file = (directory.path() / "world.ply").string();
  const Ended run =
      Generate("world " + scenarios + "minimal.json --from-s 400 --to-s 450 --out " + file);
  EXPECT_EQ(run.status, 0);
  EXPECT_NE(run.said.find(" triangles of 1 chunks in " + file), std::string::npos);
  EXPECT_GT(ReadPly(file).width, 1000U);
}

}  // namespace
}  // namespace railcast
