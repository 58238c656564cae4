#include "core/io/verify/dataset_verification.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/io/write_file.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/dataset/dataset_project.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// A recipe of three scenarios without objects.
class DatasetContentTest : public testing::Test {
 protected:
  void SetUp() override {
    nlohmann::json recipe = ProjectRecipe();
    recipe["num_scenarios"] = 3;
    recipe["num_frames"] = 1;
    recipe["objects"] = nlohmann::json::array();
    recipe_ = ReadProjectRecipe(directory_.path() / "project", recipe);
  }
  [[nodiscard]] static std::vector<fs::path> SequencesOf(const fs::path& directory) {
    return FinishedSequences(directory, ReadDatasetContent(directory));
  }
  [[nodiscard]] fs::path set() const { return directory_.path() / "set"; }
  TemporaryDirectory directory_;
  Recipe recipe_;
};

TEST_F(DatasetContentTest, OfAShardAreItsOwnSequences) {
  (void)MakeDataset(recipe_, set(), {2, 2});
  EXPECT_EQ(SequencesOf(set()), std::vector{set() / "sequences/000/000001"});
}

TEST_F(DatasetContentTest, OfSeveralSensorsAreTheSequencesOfEach) {
  nlohmann::json json = RecipeOfTwoSensors();
  json["num_scenarios"] = 1;
  (void)MakeDataset(ReadProjectRecipe(directory_.path() / "two", json), set());
  EXPECT_EQ(SequencesOf(set()), (std::vector{set() / "sequences/000/000000/front",
                                             set() / "sequences/000/000000/roof"}));
}

TEST_F(DatasetContentTest, OfAnUnfinishedDataSetIsRefused) {
  (void)MakeDataset(recipe_, set());
  EXPECT_EQ(SequencesOf(set()).size(), 3U);
  const std::string manifest = ReadFileWhole(set() / "manifest.json");
  fs::remove(set() / "manifest.json");
  const std::string rule = ": must be a finished data set (got ";
  const std::string advice =
      "); the command that began it, railcast-generate dataset, continues it";
  EXPECT_EQ(MessageOf([&] { (void)SequencesOf(set()); }),
            set().string() + rule + "no manifest.json" + advice);
  const std::string lines = ReadFileWhole(set() / "scenarios.jsonl");
  WriteFileWhole(set() / "scenarios.jsonl", lines.substr(0, lines.find('\n') + 5));
  EXPECT_EQ(MessageOf([&] { (void)SequencesOf(set()); }),
            set().string() + rule + "1 of 3 scenarios" + advice);
  fs::remove(set() / "scenarios.jsonl");
  EXPECT_EQ(MessageOf([&] { (void)SequencesOf(set()); }),
            set().string() + rule + "0 of 3 scenarios" + advice);
}

TEST_F(DatasetContentTest, OfADataSetWithAnUnfinishedSequenceIsRefused) {
  (void)MakeDataset(recipe_, set());
  fs::remove(set() / "sequences/000/000001/manifest.json");
  EXPECT_EQ(MessageOf([&] { (void)SequencesOf(set()); }),
            (set() / "sequences/000/000001").string() +
                ": must be a finished sequence, as all of a data set are (got no manifest.json); "
                "railcast-analyze verify lists all that is missing");
}

}  // namespace
}  // namespace railcast
