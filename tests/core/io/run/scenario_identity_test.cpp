#include "core/io/run/scenario_identity.h"

#include <gtest/gtest.h>

#include "core/io/content_hash.h"
#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/core/mesh/made_scenes.h"
#include "tests/generator/project_folder.h"

namespace railcast {
namespace {

TEST(ScenarioIdentity, IsTheSameInAnotherFolder) {
  const TemporaryDirectory directory;
  const ScenarioIdentity here = IdentityOf(ReadScenario(MakeProject(directory.path() / "here")));
  const ScenarioIdentity there = IdentityOf(ReadScenario(MakeProject(directory.path() / "there")));
  EXPECT_EQ(here.scenario_hash, there.scenario_hash);
  EXPECT_EQ(here.inputs, there.inputs);
}

TEST(ScenarioIdentity, NamesEveryFileOnceWithTheHashOfItsContent) {
  const TemporaryDirectory directory;
  ScenarioSpec scenario = ReadScenario(MakeProject(directory.path()));
  scenario.world.objects.push_back(scenario.world.objects[0]);
  const ScenarioIdentity identity = IdentityOf(scenario);
  ASSERT_EQ(identity.inputs.size(), 2U);
  EXPECT_EQ(identity.inputs[0].name, "beams.csv");
  EXPECT_EQ(identity.inputs[1].name, "rock.obj");
  EXPECT_EQ(identity.inputs[1].hash, ContentHash(kPyramidObj));
  EXPECT_EQ(*identity.inputs[1].bytes, kPyramidObj);
}

TEST(ScenarioIdentity, ChangesWithTheContentOfAFile) {
  const TemporaryDirectory directory;
  const ScenarioSpec scenario = ReadScenario(MakeProject(directory.path()));
  const ScenarioIdentity before = IdentityOf(scenario);
  for (const char* file : {"rock.obj", "beams.csv"}) {
    const std::string content = ReadFileWhole(directory.path() / file);
    WriteFileWhole(directory.path() / file, content + "\n");
    const ScenarioIdentity after = IdentityOf(scenario);
    EXPECT_NE(after.scenario_hash, before.scenario_hash) << file;
    EXPECT_NE(after.inputs, before.inputs) << file;
    WriteFileWhole(directory.path() / file, content);
  }
}

// Both scenarios have the same list of inputs.
TEST(ScenarioIdentity, TellsWhichObjectHasWhichOfTwoFilesOfOneName) {
  const TemporaryDirectory directory;
  ScenarioSpec scenario = ReadScenario(MakeProject(directory.path() / "a"));
  MakeProject(directory.path() / "b");
  WriteFileWhole(directory.path() / "b/rock.obj", std::string(kPyramidObj) + "f 1 2 3\n");
  const std::string a = (directory.path() / "a/rock.obj").string();
  const std::string b = (directory.path() / "b/rock.obj").string();
  scenario.world.objects.resize(3, scenario.world.objects[0]);
  scenario.world.objects[1].file = b;
  scenario.world.objects[2].file = b;
  const ScenarioIdentity abb = IdentityOf(scenario);
  scenario.world.objects[2].file = a;
  const ScenarioIdentity aba = IdentityOf(scenario);
  EXPECT_EQ(abb.inputs, aba.inputs);
  EXPECT_NE(abb.scenario_hash, aba.scenario_hash);
}

TEST(ScenarioIdentity, NamesFilesByTheirContent) {
  const TemporaryDirectory directory;
  const ScenarioSpec scenario = ReadScenario(MakeProject(directory.path()));
  const std::string rock = "inputs/" + ContentHash(kPyramidObj) + "/rock.obj";
  EXPECT_EQ(WithFilesByContent(scenario).world.objects[0].file, rock);
  const ScenarioIdentity identity = IdentityOf(scenario);
  EXPECT_NE(identity.scenario_json.find("\"" + rock + "\""), std::string::npos);
  EXPECT_EQ(identity.scenario_json.find(directory.path().string()), std::string::npos);
  EXPECT_EQ(identity.scenario_hash, ContentHash(identity.scenario_json));
}

TEST(ScenarioIdentity, IsThatOfTheScenarioReadBackFromItsCopies) {
  const TemporaryDirectory directory;
  const ScenarioIdentity identity =
      IdentityOf(ReadScenario(MakeProject(directory.path() / "project")));
  const auto copy = directory.path() / "copy";
  WriteScenarioFiles(identity, copy, "scenario.resolved.json");
  std::filesystem::remove_all(directory.path() / "project");
  EXPECT_EQ(IdentityOf(ReadScenario(copy / "scenario.resolved.json")), identity);
}

TEST(ScenarioIdentity, IsOfWhatWasReadEvenIfAFileIsEditedAfterwards) {
  const TemporaryDirectory directory;
  const Inputs inputs;
  const ScenarioSpec scenario = ReadScenario(MakeProject(directory.path()));
  const ScenarioIdentity identity = IdentityOf(scenario);
  WriteFileWhole(directory.path() / "rock.obj", std::string(kPyramidObj) + "f 1 2 3\n");
  EXPECT_EQ(IdentityOf(scenario), identity);
  WriteScenarioFiles(identity, directory.path() / "copy", "scenario.resolved.json");
  EXPECT_EQ(ReadFileWhole(directory.path() / "copy" / identity.inputs[1].CopyName()), kPyramidObj);
}

// The project with the rock as a glTF whose buffer is another file.
std::filesystem::path MakeGltfProject(const std::filesystem::path& folder) {
  const std::filesystem::path scenario = MakeProject(folder);
  std::string text = ReadFileWhole(scenario);
  WriteFileWhole(scenario, text.replace(text.find("rock.obj"), 8, "rock.gltf"));
  WriteFileWhole(folder / "rock.gltf", GltfNaming("rock.bin"));
  WriteFileWhole(folder / "rock.bin", BytesOfFloats({0, 0, 0, 1, 0, 0, 0, 1, 0}));
  return scenario;
}

TEST(ScenarioIdentity, HasTheFilesBesideAMeshInItsFolder) {
  const TemporaryDirectory directory;
  const ScenarioIdentity identity =
      IdentityOf(ReadScenario(MakeGltfProject(directory.path() / "project")));
  ASSERT_EQ(identity.inputs.size(), 3U);
  const InputFile& mesh = identity.inputs[1];
  const InputFile& buffer = identity.inputs[2];
  EXPECT_EQ(buffer.name, "rock.bin");
  EXPECT_EQ(buffer.hash, ContentHash(*buffer.bytes));
  const std::string folder =
      "inputs/" + ContentHash("rock.gltf\n" + mesh.hash + "\nrock.bin\n" + buffer.hash + "\n");
  EXPECT_EQ(mesh.CopyName(), folder + "/rock.gltf");
  EXPECT_EQ(buffer.CopyName(), folder + "/rock.bin");
  EXPECT_NE(identity.scenario_json.find(mesh.CopyName()), std::string::npos);
  WriteScenarioFiles(identity, directory.path() / "copy", "scenario.resolved.json");
  std::filesystem::remove_all(directory.path() / "project");
  EXPECT_EQ(IdentityOf(ReadScenario(directory.path() / "copy/scenario.resolved.json")), identity);
}

TEST(ScenarioIdentity, ChangesWithAFileBesideAMesh) {
  const TemporaryDirectory directory;
  const ScenarioSpec scenario = ReadScenario(MakeGltfProject(directory.path()));
  const ScenarioIdentity before = IdentityOf(scenario);
  WriteFileWhole(directory.path() / "rock.bin", BytesOfFloats({0, 0, 0, 4, 0, 0, 0, 1, 0}));
  EXPECT_NE(IdentityOf(scenario).scenario_hash, before.scenario_hash);
}

TEST(ScenarioIdentity, SaysWhichFileIsMissing) {
  const TemporaryDirectory directory;
  const ScenarioSpec scenario = ReadScenario(MakeProject(directory.path()));
  std::filesystem::remove(directory.path() / "rock.obj");
  EXPECT_EQ(MessageOf([&] { (void)IdentityOf(scenario); }),
            (directory.path() / "rock.obj").string() + ": no such file or directory");
}

}  // namespace
}  // namespace railcast
