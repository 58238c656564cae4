#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "core/io/write_file.h"
#include "railcast/scenario.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/project_folder.h"
#include "tests/generator/run_command.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using ::testing::EndsWith;
using ::testing::HasSubstr;

// Names and contents of a folder's files.
std::map<std::string, std::string> FilesIn(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    files[entry.path().filename()] = ReadFileWhole(entry.path());
  }
  return files;
}

TEST(Randomize, WritesScenariosThatAreSoundAndDifferFromTheirBaseInWeatherAlone) {
  const TemporaryDirectory directory;
  const fs::path base_file = MakeProject(directory.path() / "project");
  const fs::path out = directory.path() / "weathers";
  const Ended run =
      Generate("randomize " + base_file.string() + " --count 12 --out " + out.string());
  EXPECT_EQ(run.status, 0) << run.said;
  const ScenarioSpec base = ReadScenario(base_file);
  ASSERT_EQ(FilesIn(out).size(), 12U);
  for (const auto& [name, text] : FilesIn(out)) {
    EXPECT_THAT(CheckScenario(out / name), ::testing::IsEmpty()) << name;
    ScenarioSpec drawn = ReadScenario(out / name);
    EXPECT_NE(drawn.weather, base.weather) << name;
    drawn.weather = base.weather;
    drawn.sources = base.sources;
    EXPECT_EQ(drawn, base) << name;
  }
}

TEST(Randomize, GivesTheSameFilesForTheSameSeedHoweverMany) {
  const TemporaryDirectory directory;
  const std::string base = MakeProject(directory.path()).string();
  const auto files = [&](const std::string& folder, const std::string& options) {
    const fs::path out = directory.path() / folder;
    EXPECT_EQ(Generate("randomize " + base + " --out " + out.string() + " " + options).status, 0);
    return FilesIn(out);
  };
  const auto five = files("a", "--count 5");
  auto eight = files("b", "--count 8");
  EXPECT_NE(five, files("c", "--count 5 --seed 2"));
  while (eight.size() > 5) eight.erase(std::prev(eight.end()));
  EXPECT_EQ(five, eight);
  for (const auto& [name, text] : files("d", "--count 6 --weather foggy,rainy")) {
    EXPECT_TRUE(name.ends_with("_foggy.json") || name.ends_with("_rainy.json")) << name;
  }
}

TEST(Randomize, LeavesAFolderThatHoldsSomethingAlone) {
  const TemporaryDirectory directory;
  const std::string base = MakeProject(directory.path()).string();
  const Ended run = Generate("randomize " + base + " --out " + directory.path().string());
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.said,
            "--out: must be a new or an empty folder (got " + directory.path().string() + ")\n");
  EXPECT_EQ(FilesIn(directory.path()).size(), 3U);
}

TEST(Randomize, RefusesAPathThatJsonCannotHold) {
  const TemporaryDirectory directory;
  const fs::path base = MakeProject(directory.path() / "proj\xff");
  const std::string out = (directory.path() / "out").string();
  const Ended run = Generate("randomize '" + base.string() + "' --out " + out);
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.said, EndsWith(": the path must be UTF-8, to stand in JSON\n"));
  EXPECT_FALSE(fs::exists(out));
}

TEST(Randomize, NeedsTheMaterialOfSnowForSnow) {
  const TemporaryDirectory directory;
  const fs::path base = MakeProject(directory.path() / "project");
  std::string materials = ReadFileWhole(fs::path(scenarios_folder) / "materials/railway.json");
  const std::size_t name = materials.find("\"snow\"");
  ASSERT_NE(name, std::string::npos);
  materials.replace(name, 6, "\"firn\"");
  WriteFileWhole(directory.path() / "project/materials.json", materials);
  std::string text = ReadFileWhole(base);
  const std::string library = scenarios_folder + "materials/railway.json";
  text.replace(text.find(library), library.size(), "materials.json");
  WriteFileWhole(base, text);
  const std::string out = (directory.path() / "out").string();
  const Ended run = Generate("randomize " + base.string() + " --out " + out);
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.said, HasSubstr("\"snow\""));
  EXPECT_FALSE(fs::exists(out));
  EXPECT_EQ(
      Generate("randomize " + base.string() + " --weather sunny,foggy,rainy --out " + out).status,
      0);
}

}  // namespace
}  // namespace railcast
