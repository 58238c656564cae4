#include "core/extras/recipe/dataset_verification.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "core/io/content_hash.h"
#include "core/io/record/record_text.h"
#include "core/io/run/sensors_record.h"
#include "core/io/write_file.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/dataset/dataset_project.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A data set of two scenarios. The tests change its files one by one.
class VerifyDatasetTest : public testing::Test {
 protected:
  void SetUp() override {
    nlohmann::json recipe = ProjectRecipe();
    recipe["num_scenarios"] = 2;
    recipe["objects"] = nlohmann::json::array();
    recipe_ = ReadProjectRecipe(directory_.path() / "project", recipe);
    (void)MakeDataset(recipe_, Path());
  }
  [[nodiscard]] fs::path Path(const std::string& name = "") const {
    return directory_.path() / "set" / name;
  }
  [[nodiscard]] std::vector<std::string> Faults() const {
    return VerifyDataset(directory_.path() / "set", [](double) {}).faults;
  }
  TemporaryDirectory directory_;
  Recipe recipe_;
};

TEST_F(VerifyDatasetTest, FindsAWholeDataSetWhole) {
  EXPECT_TRUE(IsDataset(directory_.path() / "set"));
  EXPECT_FALSE(IsDataset(Path("sequences/000/000000")));
  const Verification found = VerifyDataset(directory_.path() / "set", [](double) {});
  EXPECT_THAT(found.faults, IsEmpty());
  EXPECT_EQ(found.num_frames, 6U);
}

TEST_F(VerifyDatasetTest, FindsChangedFiles) {
  WriteFileWhole(Path("split/train.txt"), "mine\n");
  WriteFileWhole(Path("sequences/000/000001/frames/000002.pcd"), "nothing");
  EXPECT_THAT(Faults(), ElementsAre(HasSubstr("set/split/train.txt: must have the hash "),
                                    HasSubstr("000001/frames/000002.pcd: must have ")));
}

TEST_F(VerifyDatasetTest, FindsMissingAndForeignFiles) {
  fs::remove(Path("index.jsonl"));
  fs::remove_all(Path("sequences/000/000000"));
  WriteFileWhole(Path("note.txt"), "mine");
  fs::create_directories(Path("sequences/000/000007"));
  WriteFileWhole(Path("sequences/000/000007/run.json"), "{}");
  const std::vector<std::string> faults = Faults();
  EXPECT_EQ(faults.size(), 4U);
  EXPECT_THAT(faults, Contains(HasSubstr("index.jsonl: no such file")));
  EXPECT_THAT(faults, Contains(HasSubstr("sequences/000/000000/run.json: no such file")));
  EXPECT_THAT(faults, Contains(HasSubstr("note.txt: belongs to no scenario of the data set")));
  EXPECT_THAT(faults, Contains(HasSubstr("000007/run.json: belongs to no scenario")));
}

TEST_F(VerifyDatasetTest, ADatabaseOfTheIndexIsNoForeignFile) {
  WriteFileWhole(Path("index.sqlite"), "made of index.jsonl");
  EXPECT_THAT(Faults(), IsEmpty());
}

TEST_F(VerifyDatasetTest, FindsASequenceOfAnotherRunInPlaceOfItsOwn) {
  fs::remove_all(Path("sequences/000/000001"));
  fs::copy(Path("sequences/000/000000"), Path("sequences/000/000001"), fs::copy_options::recursive);
  EXPECT_THAT(Faults(), ElementsAre(HasSubstr("sequences/000/000001/manifest.json: must have the "
                                              "hash ")));
}

TEST_F(VerifyDatasetTest, AnUnfinishedDataSetIsAFaultButAFinishedShardIsNone) {
  fs::remove(Path("manifest.json"));
  EXPECT_THAT(Faults(), Contains(HasSubstr("manifest.json: missing: the data set is unfinished")));
  const fs::path shard = directory_.path() / "shard";
  (void)MakeDataset(recipe_, shard, {2, 2});
  EXPECT_THAT(VerifyDataset(shard, [](double) {}).faults, IsEmpty());
  fs::rename(shard / "manifest.json", directory_.path() / "kept");
  EXPECT_THAT(
      VerifyDataset(shard, [](double) {}).faults,
      ElementsAre((shard / "manifest.json").string() + ": missing: the shard is unfinished"));
  fs::rename(directory_.path() / "kept", shard / "manifest.json");
  WriteFileWhole(shard / "scenarios.jsonl", "");
  EXPECT_THAT(VerifyDataset(shard, [](double) {}).faults,
              Contains(HasSubstr("must have a line for each of 1 scenarios (got 0)")));
}

TEST_F(VerifyDatasetTest, FindsAChangedLineOfAScenario) {
  const fs::path shard = directory_.path() / "shard";
  (void)MakeDataset(recipe_, shard, {2, 2});
  const std::string whole = ReadFileWhole(shard / "scenarios.jsonl");
  const auto faults_after = [&](const std::string& from, const std::string& to) {
    std::string line = whole;
    line.replace(line.find(from), from.size(), to);
    WriteFileWhole(shard / "scenarios.jsonl", line);
    return VerifyDataset(shard, [](double) {}).faults;
  };
  const std::string split = nlohmann::json::parse(whole).at("split");
  for (const auto& [from, to] : {std::pair<std::string, std::string>{split, "other"},
                                 {"\"start_s_m\":", "\"start_s_m\":1"},
                                 {"\"points\":", "\"points\":1"}}) {
    EXPECT_THAT(faults_after(from, to),
                testing::IsSupersetOf({HasSubstr("scenarios.jsonl: must have the hash "),
                                       HasSubstr("scenarios.jsonl:1: /line_xxh3: must be ")}))
        << to;
  }
  EXPECT_THAT(faults_after("\"points\":", "\"points\":1"),
              Contains(HasSubstr("scenarios.jsonl:1: /sequences: points: must be ")));
}

TEST_F(VerifyDatasetTest, ReadsTheSequencesAndTheMergedCloudsOfSeveralSensors) {
  const Recipe recipe = ReadProjectRecipe(directory_.path() / "two", RecipeOfTwoSensors());
  DatasetChoices choices = OnOneThread(directory_.path() / "of_two");
  choices.is_merged = true;
  (void)RunDataset(recipe, choices, NoDatasetHooks());
  const auto faults = [&] { return VerifyDataset(choices.directory, [](double) {}).faults; };
  EXPECT_THAT(faults(), IsEmpty());
  EXPECT_EQ(VerifyDataset(choices.directory, [](double) {}).num_frames, 18U);
  const fs::path scenario = choices.directory / "sequences/000/000001";
  WriteFileWhole(scenario / "roof/frames/000002.pcd", "nothing");
  WriteFileWhole(scenario / "merged/frames/000000.pcd", "nothing");
  WriteFileWhole(scenario / "notes.txt", "mine");
  EXPECT_THAT(faults(), ElementsAre(HasSubstr("000001/roof/frames/000002.pcd: must have "),
                                    HasSubstr("000001/merged/frames/000000.pcd: must have "),
                                    HasSubstr("000001/notes.txt: belongs to none of")));
}

using Faults = std::vector<std::string>;

class VerifyMergedClouds : public testing::Test {
 protected:
  VerifyMergedClouds() {
    fs::create_directories(merged_.folder / "frames");
    std::string lines;
    for (const std::string name : {"frames/000000.pcd", "frames/000001.pcd"}) {
      WriteFileWhole(merged_.folder / name, name);
      lines += RecordText(MergedRecord{.file = {name, ContentHash(name), 17}}) + "\n";
    }
    WriteFileWhole(merged_.folder / "merged.jsonl", lines);
    merged_.files = {{"merged.jsonl", ContentHash(lines), std::nullopt}};
  }
  [[nodiscard]] Faults FaultsFound() const {
    Faults faults = VerifyMerged(merged_, [](double) {}).faults;
    const std::string folder = merged_.folder.string() + "/";
    for (std::string& fault : faults) fault.erase(0, folder.size());
    return faults;
  }

  const TemporaryDirectory directory_;
  MergedFolder merged_{directory_.path() / "merged", {}};
};

TEST_F(VerifyMergedClouds, ReadsEveryFile) {
  const Verification found = VerifyMerged(merged_, [](double) {});
  EXPECT_EQ(found.faults, Faults());
  EXPECT_EQ(found.num_frames, 2U);
  EXPECT_EQ(found.num_files, 3U);
}

TEST_F(VerifyMergedClouds, NamesAChangedCloud) {
  std::ofstream(merged_.folder / "frames/000001.pcd") << "frames/00000X.pcd";
  ASSERT_EQ(FaultsFound().size(), 1U);
  EXPECT_EQ(FaultsFound()[0].find("frames/000001.pcd: "), 0U);
}

TEST_F(VerifyMergedClouds, NamesAMissingCloudAndAForeignFile) {
  fs::remove(merged_.folder / "frames/000000.pcd");
  std::ofstream(merged_.folder / "photo.jpg") << "mine";
  const Faults faults = FaultsFound();
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0].find("frames/000000.pcd: "), 0U);
  EXPECT_EQ(faults[1], "photo.jpg: is named neither in sensors.json nor in merged.jsonl");
}

TEST_F(VerifyMergedClouds, NamesAChangedListOfClouds) {
  std::ofstream(merged_.folder / "merged.jsonl", std::ios::app) << "{}\n";
  const Faults faults = FaultsFound();
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0].find("merged.jsonl: "), 0U);
  EXPECT_EQ(faults[1].find("merged.jsonl:3: /frame: missing"), 0U);
}

}  // namespace
}  // namespace railcast
