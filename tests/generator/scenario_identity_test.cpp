#include "generator/scenario_identity.h"

#include <gtest/gtest.h>

#include "core/io/content_hash.h"
#include "core/scenario/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
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
  EXPECT_EQ(identity.inputs[1], (InputFile{"rock.obj", ContentHash(kPyramidObj)}));
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

// The list of inputs is then the same.
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

TEST(ScenarioIdentity, SaysWhichFileIsMissing) {
  const TemporaryDirectory directory;
  const ScenarioSpec scenario = ReadScenario(MakeProject(directory.path()));
  std::filesystem::remove(directory.path() / "rock.obj");
  EXPECT_EQ(MessageOf([&] { (void)IdentityOf(scenario); }),
            (directory.path() / "rock.obj").string() + ": no such file or directory");
}

}  // namespace
}  // namespace railcast
