#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/trace/trace_program.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/example_run.h"
#include "tests/generator/project_folder.h"
#include "tests/generator/run_command.h"

namespace railcast {
namespace {

using Json = nlohmann::json;

// "+14c4fad0a1b2" or "+14c4fad0a1b2.dirty.0f3a77c1" where the tree is in a repository, else empty.
std::string CommitPattern() {
  const bool is_repository = std::filesystem::exists(RAILCAST_SOURCE_DIR "/.git");
  return is_repository ? R"(\+([0-9a-f]+(\.dirty\.[0-9a-f]+)?|unknown))" : "";
}

TEST(Provenance, NamesTheCommitInTheVersion) {
  const Ended run = Generate("--version");
  EXPECT_EQ(run.status, 0);
  EXPECT_THAT(run.said,
              testing::MatchesRegex("railcast " RAILCAST_VERSION "(" + CommitPattern() + ")\n"));
}

TEST(Provenance, StandsInRunJson) {
  const TemporaryDirectory directory;
  const std::string scenario = MakeProject(directory.path()).string();
  const auto out = directory.path() / "out";
  ASSERT_EQ(Generate("sequence " + scenario + " --frames 1 --out " + out.string()).status, 0);
  const Json run = Json::parse(ReadFileWhole(out / "run.json"));
  EXPECT_EQ("railcast " + run.at("version").get<std::string>() + "\n", Generate("--version").said);
  EXPECT_EQ(run.at("embree"), EmbreeVersion());
  EXPECT_EQ(run.at("isa"), IsaInUse(""));
}

TEST(Provenance, OfAForcedInstructionSetIsThatOneAndIsNotMixedWithAnother) {
  const TemporaryDirectory directory;
  const std::string scenario = MakeProject(directory.path()).string();
  const auto out = directory.path() / "out";
  const std::string command = "sequence " + scenario + " --frames 2 --out " + out.string();
  ASSERT_EQ(Generate(command + " --isa sse4.2").status, 0);
  EXPECT_EQ(Json::parse(ReadFileWhole(out / "run.json")).at("isa"), "sse4.2");
  const auto made = Contents(out);
  std::filesystem::remove(out / "manifest.json");
  std::filesystem::remove(out / "frames/000001.pcd");
  const Ended mixed = Generate(command);
  EXPECT_EQ(mixed.status, 1);
  EXPECT_EQ(mixed.said, out.string() +
                            ": must be continued with the instruction set that it was begun with, "
                            "sse4.2 (got " +
                            IsaInUse("") + "); add --isa sse4.2, or choose another --out\n");
  EXPECT_EQ(Generate(command + " --isa sse4.2").status, 0);
  EXPECT_EQ(Contents(out), made);
}

// The bytes are the same whether the best instruction set is named or chosen by default, so a run
// can be resumed either way.
TEST(Provenance, OfTheBestInstructionSetIsTheSameWhetherForcedOrNot) {
  const std::string best = IsaInUse("");
  ASSERT_THAT(IsaNames(), testing::Contains(best));
  const TemporaryDirectory directory;
  const std::string command = "sequence " + scenarios_folder + "minimal.json --frames 2 --out " +
                              directory.path().string() + "/";
  ASSERT_EQ(Generate(command + "forced --isa " + best).status, 0);
  ASSERT_EQ(Generate(command + "left").status, 0);
  const auto made = Contents(directory.path() / "left");
  EXPECT_EQ(Contents(directory.path() / "forced"), made);
  // The option is not only recorded but changes the trace; docs/accuracy.md states by how much.
  ASSERT_EQ(Generate(command + "narrow --isa sse4.2").status, 0);
  const auto narrow = Contents(directory.path() / "narrow");
  EXPECT_EQ(narrow.at("frames/000000.pcd") == made.at("frames/000000.pcd"), best == "sse4.2");
}

TEST(Provenance, TakesNoOtherInstructionSet) {
  for (const char* command :
       {"sequence a.json --out b", "stream a.json", "trace a.json --firing 0"}) {
    const Ended run = Generate(std::string(command) + " --isa avx1024");
    EXPECT_EQ(run.status, 2);
    EXPECT_THAT(run.said, testing::StartsWith("--isa: ")) << run.said;
  }
}

}  // namespace
}  // namespace railcast
