#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "core/extras/recipe/dataset_verification.h"
#include "core/io/write_file.h"
#include "generator/extras/dataset/dataset_report.h"
#include "generator/extras/dataset/run_dataset.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/dataset/dataset_project.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

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

IndexedFrame FrameOf(const std::string& hash, const std::vector<std::string>& persons) {
  IndexedFrame frame;
  frame.record.files = {{"frames/000000.pcd", hash, 100}, {"image/000000.png", "image", 50}};
  for (const std::string& person : persons) {
    IndexObjectRecord& object = frame.objects.emplace_back();
    object.name = person;
    object.type = "person";
  }
  return frame;
}

IndexedScenario ScenarioOf(std::uint32_t number, std::vector<IndexedFrame> frames) {
  return {{.scenario = number,
           .base = "base.json",
           .split = "train",
           .line = "",
           .sequences = {{.sensor = "front",
                          .folder = "",
                          .scenario_hash = "",
                          .data_hash = "",
                          .manifest_hash = ""}}},
          {std::move(frames)}};
}

TEST(DatasetReport, CountsFramesThatAnotherOneHasTheBytesOf) {
  DatasetReport report;
  report.Add(ScenarioOf(0, {FrameOf("a", {}), FrameOf("b", {}), FrameOf("a", {})}));
  report.Add(ScenarioOf(1, {FrameOf("c", {}), FrameOf("a", {})}));
  EXPECT_EQ(report.Record().duplicate_frames, 2U);
}

TEST(DatasetReport, CountsAnObjectOnceAScenario) {
  DatasetReport report;
  report.Add(ScenarioOf(0, {FrameOf("a", {"anna"}), FrameOf("b", {"anna", "ben"})}));
  report.Add(ScenarioOf(1, {FrameOf("c", {"anna"})}));
  const TypeCountsRecord persons = report.Record().objects.at("person");
  EXPECT_EQ(persons.objects, 3U);
  EXPECT_EQ(persons.in_frames, 4U);
}

constexpr std::int64_t kMs = 1'000'000;

class DatasetOfSeveralSensors : public testing::Test {
 protected:
  [[nodiscard]] fs::path Path(const std::string& name) const { return directory_.path() / name; }
  DatasetResult Make(const std::string& name, const Shard& shard = {}) const {
    DatasetChoices choices = OnOneThread(Path(name), shard);
    choices.is_merged = true;
    return RunDataset(recipe_, choices, NoDatasetHooks());
  }

  const TemporaryDirectory directory_;
  const Recipe recipe_ = ReadProjectRecipe(directory_.path() / "project", RecipeOfTwoSensors());
};

TEST_F(DatasetOfSeveralSensors, HasASequenceOfEachAndTheirMergedClouds) {
  // 2 frames of the front last 0.2 s, in which 4 of the roof begin.
  EXPECT_EQ(Make("set").num_frames, 3U * (2 + 4));
  const fs::path scenario = Path("set/sequences/000/000001");
  EXPECT_TRUE(fs::exists(scenario / "front/frames/000001.pcd"));
  EXPECT_TRUE(fs::exists(scenario / "roof/frames/000003.pcd"));
  EXPECT_TRUE(fs::exists(scenario / "merged/frames/000001.pcd"));
  EXPECT_TRUE(fs::exists(scenario / "sensors.json"));
  std::istringstream lines(ReadFileWhole(Path("set/index.jsonl")));
  std::vector<std::string> frames;
  for (std::string line; std::getline(lines, line);) {
    const Json frame = Json::parse(line);
    if (frame.at("scenario") != 1) continue;
    frames.push_back(frame.at("sensor").get<std::string>() + " " +
                     std::to_string(frame.at("stamp_ns").get<std::int64_t>() / kMs));
    EXPECT_EQ(frame.at("folder"), "sequences/000/000001/" + frame.at("sensor").get<std::string>());
  }
  EXPECT_THAT(frames,
              ElementsAre("front 0", "front 100", "roof 30", "roof 80", "roof 130", "roof 180"));
  const Json report = Json::parse(ReadFileWhole(Path("set/report.json")));
  EXPECT_EQ(report.at("frames_by_sensor"), Json({{"front", 6}, {"roof", 12}}));
}

TEST_F(DatasetOfSeveralSensors, KeepsASensorsSequencesInOnePart) {
  static_cast<void>(Make("set"));
  std::multiset<std::string> scenarios;
  for (const char* const split : {"train", "val", "test"}) {
    std::istringstream folders(ReadFileWhole(Path("set/split") / (std::string(split) + ".txt")));
    std::set<std::string> own;
    for (std::string folder; std::getline(folders, folder);) {
      EXPECT_TRUE(fs::exists(Path("set") / folder / "manifest.json"));
      own.insert(fs::path(folder).parent_path());
    }
    scenarios.insert(own.begin(), own.end());
  }
  EXPECT_THAT(scenarios,
              ElementsAre("sequences/000/000000", "sequences/000/000001", "sequences/000/000002"));
}

TEST_F(DatasetOfSeveralSensors, IsTheSameOfShards) {
  static_cast<void>(Make("whole"));
  static_cast<void>(Make("a", {1, 2}));
  static_cast<void>(Make("b", {2, 2}));
  EXPECT_EQ(MergeShards({Path("a"), Path("b")}, Path("merged"), [](auto, auto) {}), 3U);
  EXPECT_EQ(FilesOfDataset(Path("merged")), FilesOfDataset(Path("whole")));
}

TEST_F(DatasetOfSeveralSensors, IsMergedOfWhatItsScenariosSay) {
  static_cast<void>(Make("a", {1, 2}));
  static_cast<void>(Make("b", {2, 2}));
  WriteFileWhole(Path("b/sequences/000/000001/sensors.json"), "{}");
  EXPECT_THAT(
      MessageOf([&] {
        static_cast<void>(MergeShards({Path("a"), Path("b")}, Path("merged"), [](auto, auto) {}));
      }),
      HasSubstr("b/sequences/000/000001/sensors.json: must have the hash "));
}

TEST_F(DatasetOfSeveralSensors, IsMendedWhereAMergedCloudOrTheirListIsMissing) {
  static_cast<void>(Make("set"));
  const auto whole = FilesOfDataset(Path("set"));
  for (const char* const file : {"merged/frames/000001.pcd", "sensors.json"}) {
    fs::remove(Path("set/sequences/000/000001") / file);
    EXPECT_THAT(Make("set").changed,
                testing::Contains(HasSubstr(std::string("000001/") + file + ": ")));
    EXPECT_TRUE(FilesOfDataset(Path("set")) == whole) << file;
  }
}

TEST_F(DatasetOfSeveralSensors, NeedsAFrameOfEach) {
  nlohmann::json json = RecipeOfTwoSensors();
  json["num_frames"] = 1;
  json["set"]["/lidars"][1]["scan"]["rate_hz"] = 5;
  json["set"]["/lidars"][1]["phase_s"] = 0.15;
  const Recipe recipe = ReadProjectRecipe(directory_.path() / "other", json);
  EXPECT_THAT(MessageOf([&] { static_cast<void>(MakeDataset(recipe, Path("set"))); }),
              HasSubstr("/num_frames: scenario 0: must last until a frame of /lidars/1 begins"));
}

}  // namespace
}  // namespace railcast
