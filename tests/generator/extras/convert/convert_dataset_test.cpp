#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/base/text.h"
#include "core/extras/recipe/dataset_verification.h"
#include "core/io/write_file.h"
#include "tests/core/io/message_of.h"
#include "tests/generator/extras/convert/converted.h"
#include "tests/generator/extras/dataset/dataset_project.h"
#include "tests/generator/extras/dataset/recording_recipe.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

class ConvertDatasetOfInsertions : public RecordingRecipe {};

/// The clouds are those that insertions in that format have, and all else is that of the set.
TEST_F(ConvertDatasetOfInsertions, MakesSequencesWithTheSameIndexAndSplits) {
  const Recipe recipe = Read(Boxes());
  (void)Make(recipe, "set");
  DatasetChoices in_ply = Choices("in_ply");
  in_ply.format = "ply";
  (void)RunDataset(recipe, in_ply, NoDatasetHooks());
  const ConvertChoices choices = {
      .recording = Path("set"), .directory = Path("converted"), .format = "ply"};
  EXPECT_FALSE(ConvertAll(choices, 9).is_complete);
  const ConvertResult result = ConvertAll(choices);
  EXPECT_TRUE(result.is_complete);
  EXPECT_EQ(result.lost.at("lists of what was put into a frame"), 30U);
  EXPECT_THAT(VerifyDataset(Path("converted"), [](double) {}).faults, testing::IsEmpty());

  const auto converted = FilesOfDataset(Path("converted"));
  const std::string folder = "/recording/";
  std::size_t num_clouds = 0;
  for (const auto& [inserted, bytes] : FilesOfDataset(Path("in_ply"))) {
    std::string name = inserted;
    const std::size_t at = name.find(folder);
    if (at == name.npos || !name.ends_with(".ply")) continue;
    name.replace(at, folder.size(), "/");
    EXPECT_EQ(converted.at(name), bytes) << name;
    ++num_clouds;
  }
  EXPECT_EQ(num_clouds, 30U);
  const auto in_sequences = [&](std::string lines) {
    for (std::size_t at = 0; (at = lines.find("/recording")) != lines.npos;) lines.erase(at, 10);
    for (std::size_t at = 0; (at = lines.find(".pcd")) != lines.npos;) lines.replace(at, 4, ".ply");
    return lines;
  };
  for (const char* const name :
       {"index.jsonl", "split/train.txt", "split/val.txt", "split/test.txt"}) {
    EXPECT_EQ(converted.at(name), in_sequences(ReadFileWhole(Path("set") / name))) << name;
  }
}

TEST_F(ConvertDatasetOfInsertions, TellsWhatItMadeAnew) {
  nlohmann::json json = Boxes();
  json["num_scenarios"] = 1;
  (void)Make(Read(json), "set");
  fs::remove_all(Path("converted"));
  const ConvertChoices choices = {
      .recording = Path("set"), .directory = Path("converted"), .format = "ply"};
  EXPECT_THAT(ConvertAll(choices).changed, testing::IsEmpty());
  WriteFileWhole(Path("converted/split/val.txt"), "another\n");
  const ConvertResult mended = ConvertAll(choices);
  EXPECT_FALSE(mended.was_complete);
  EXPECT_TRUE(mended.is_complete);
  EXPECT_THAT(mended.changed, testing::ElementsAre(testing::HasSubstr("split/val.txt: ")));
}

TEST_F(ConvertDatasetOfInsertions, RefusesThoseIntoRecordingsThatAreNoSequences) {
  fs::remove_all(Path("clouds"));
  fs::copy(Path("one/frames"), Path("clouds"));
  nlohmann::json json = Boxes();
  json["num_scenarios"] = 1;
  json["bases"] = nlohmann::json::parse(R"([{"file": "standing.json", "recordings": ["clouds"]}])");
  WriteFileWhole(Path("standing.json"), StandingPlan());
  (void)Make(Read(json), "set");
  fs::remove_all(Path("converted"));
  EXPECT_EQ(MessageOf([&] {
              (void)ConvertAll(
                  {.recording = Path("set"), .directory = Path("converted"), .format = "ply"});
            }),
            ShownPath(Path("set/sequences/000/000000")) +
                ": must be an insertion into a sequence in another format than kitti: other "
                "recordings do not hold what a data set lists of frames");
}

}  // namespace
}  // namespace railcast
