#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/io/recording/sequence_check.h"
#include "core/mesh/assimp_reader.h"
#include "core/trace/trace_program.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/core/mesh/made_scenes.h"
#include "tests/generator/example_run.h"
#include "tests/generator/project_folder.h"
#include "tests/generator/run_command.h"
#include "tests/support/exits_with.h"

namespace railcast {
namespace {

using Json = nlohmann::json;

// "+14c4fad0a1b2" or "+14c4fad0a1b2.dirty.0f3a77c1" where the tree is in a repository, else empty.
std::string CommitPattern() {
  const bool is_repository = std::filesystem::exists(RAILCAST_SOURCE_DIR "/.git");
  return is_repository ? R"(\+([0-9a-f]+(\.dirty\.[0-9a-f]+)?|unknown))" : "";
}

TEST(Provenance, NamesTheCommitInTheVersion) {
  EXPECT_THAT(Generate("--version"),
              ExitsWith(0, testing::MatchesRegex("railcast " RAILCAST_VERSION "(" +
                                                 CommitPattern() + ")\n")));
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
  EXPECT_THAT(
      Generate(command),
      ExitsWith(1, out.string() +
                       ": must be continued with the instruction set that it was begun with, "
                       "sse4.2 (got " +
                       IsaInUse("") + "); add --isa sse4.2, or choose another --out\n"));
  EXPECT_EQ(Generate(command + " --isa sse4.2").status, 0);
  EXPECT_EQ(Contents(out), made);
}

// The bytes are the same whether the best instruction set is named or chosen by default, so a run
// can be resumed either way.
TEST(Provenance, OfTheBestInstructionSetIsTheSameWhetherForcedOrNot) {
  const std::string best = IsaInUse("");
  ASSERT_THAT(IsaNames(), testing::Contains(best));
  const TemporaryDirectory directory;
  const std::string command = "sequence " + kScenariosFolder + "minimal.json --frames 2 --out " +
                              directory.path().string() + "/";
  ASSERT_EQ(Generate(command + "forced --isa " + best).status, 0);
  ASSERT_EQ(Generate(command + "left").status, 0);
  const auto made = Contents(directory.path() / "left");
  EXPECT_EQ(Contents(directory.path() / "forced"), made);
  // The option is not only recorded but changes the trace; docs/results/accuracy.md states by how
  // much.
  ASSERT_EQ(Generate(command + "narrow --isa sse4.2").status, 0);
  const auto narrow = Contents(directory.path() / "narrow");
  EXPECT_EQ(narrow.at("frames/000000.pcd") == made.at("frames/000000.pcd"), best == "sse4.2");
}

// A project whose rock is a glTF with its buffer in another file, 2 m to the left of the track.
std::filesystem::path MakeProjectWithBuffer(const std::filesystem::path& folder) {
  const std::filesystem::path scenario = MakeProject(folder);
  std::string text = ReadFileWhole(scenario);
  WriteFileWhole(scenario, text.replace(text.find("rock.obj"), 8, "rock.gltf"));
  WriteFileWhole(folder / "rock.gltf", GltfNaming("rock.bin"));
  WriteFileWhole(folder / "rock.bin", BytesOfFloats({0, 0, 0, 0, 0, 3, 0, 3, 0}));
  return scenario;
}

class ProvenanceOfABuffer : public testing::Test {
 protected:
  void SetUp() override {
    if (!HasAssimp()) GTEST_SKIP() << "built without assimp";
    ASSERT_EQ(Generate(Command()).status, 0);
  }

  [[nodiscard]] std::string Command() const {
    return "sequence " + scenario_.string() + " --frames 2 --out " + out_.string();
  }
  void MoveAVertex() const {
    WriteFileWhole(directory_.path() / "project/rock.bin",
                   BytesOfFloats({0, 0, 0, 0, 0, 3, 3, 3, 0}));
  }

  const TemporaryDirectory directory_;
  const std::filesystem::path scenario_ = MakeProjectWithBuffer(directory_.path() / "project");
  const std::filesystem::path out_ = directory_.path() / "out";
};

// As after a kill: without manifest and the second frame.
TEST_F(ProvenanceOfABuffer, IsNotMixedWithAnother) {
  const auto made = Contents(out_);
  std::filesystem::remove(out_ / "manifest.json");
  std::filesystem::remove(out_ / "frames/000001.pcd");
  MoveAVertex();
  EXPECT_THAT(
      Generate(Command()),
      ExitsWith(1, out_.string() + ": holds a run with another content of rock.bin; choose another "
                                   "--out\n"));
  const std::filesystem::path copies =
      std::filesystem::path(Json::parse(ReadFileWhole(out_ / "scenario.resolved.json"))
                                .at("world")
                                .at("objects")
                                .at(0)
                                .at("file")
                                .get<std::string>())
          .parent_path();
  WriteFileWhole(directory_.path() / "project/rock.bin", ReadFileWhole(out_ / copies / "rock.bin"));
  EXPECT_EQ(Generate(Command()).status, 0);
  EXPECT_EQ(Contents(out_), made);
}

TEST_F(ProvenanceOfABuffer, IsThereWhereverTheDirectoryIs) {
  const std::filesystem::path moved = directory_.path() / "moved";
  std::filesystem::rename(out_, moved);
  std::filesystem::remove_all(directory_.path() / "project");
  const std::string scenario = (moved / "scenario.resolved.json").string();
  EXPECT_THAT(Generate("trace " + scenario + " --firing 0"), ExitsWith(0));
  EXPECT_EQ(Generate("check " + scenario).status, 0);
}

// The same check is railcast-analyze verify's, with and without a manifest.
TEST_F(ProvenanceOfABuffer, IsHeldByTheDirectorysHashes) {
  EXPECT_NO_THROW(CheckKnownFiles(ReadSequenceSummary(out_)));
  const Json run = Json::parse(ReadFileWhole(out_ / "run.json"));
  const Json& buffer = run.at("inputs").at(2);
  EXPECT_EQ(buffer.at("name"), "rock.bin");
  const std::string copy = "inputs/" + buffer.at("folder").get<std::string>() + "/rock.bin";
  WriteFileWhole(out_ / copy, BytesOfFloats({0, 0, 0, 0, 0, 3, 3, 3, 0}));
  const auto complaint = [&] {
    return MessageOf([&] { CheckKnownFiles(ReadSequenceSummary(out_)); });
  };
  EXPECT_THAT(complaint(), testing::HasSubstr(copy));
  std::filesystem::remove(out_ / "manifest.json");
  EXPECT_THAT(complaint(), testing::HasSubstr(copy));
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
