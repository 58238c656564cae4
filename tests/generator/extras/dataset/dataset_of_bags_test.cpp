#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/generator/extras/dataset/dataset_in_format.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Data sets whose clouds are in bags of ROS 2.
class DatasetOfBags : public DatasetInFormat {
 protected:
  [[nodiscard]] std::string BagName() const {
    return GetParam() == std::string("mcap") ? "frames.mcap" : "rosbag2";
  }
};

INSTANTIATE_TEST_SUITE_P(Formats, DatasetOfBags, testing::Values("mcap", "rosbag2"));

TEST_P(DatasetOfBags, SaysInItsIndexWhereTheCloudsAre) {
  Make("set");
  std::istringstream lines(ReadFileWhole(Path("set/index.jsonl")));
  std::size_t num_lines = 0;
  for (std::string line; std::getline(lines, line); ++num_lines) {
    const Json frame = Json::parse(line);
    const std::string sensor = frame.at("sensor");
    EXPECT_EQ(frame.at("files"), Json::array());
    EXPECT_EQ(frame.at("bag"),
              Json({{"path", "../" + BagName()}, {"topics", {"/" + sensor + "/points"}}}));
    const fs::path bag = Path("set") / frame.at("folder").get<std::string>() / "..";
    EXPECT_TRUE(fs::exists(bag / BagName()));
  }
  EXPECT_EQ(num_lines, 3U * (2 + 4));
  EXPECT_THAT(FaultsOf("set"), IsEmpty());
}

TEST_P(DatasetOfBags, IsTheSameOfShardsAndIsWholeThen) {
  ExpectTheSameOfShards();
}

TEST_P(DatasetOfBags, HasTheSameBytesAfterAnInterruption) {
  ExpectTheSameAfterAnInterruption();
}

TEST_P(DatasetOfBags, IsMendedWhereABagIsMissing) {
  ExpectMendedWithout(BagName());
}

TEST_P(DatasetOfBags, HasThePointsOfOneOfFiles) {
  recipe_ = ReadProjectRecipe(directory_.path() / "other", ProjectRecipe());
  Make("bags");
  (void)MakeDataset(recipe_, Path("files"));
  const DatasetContent content = ReadDatasetContent(Path("bags"));
  const auto sequences = FinishedSequences(Path("bags"), content);
  ASSERT_EQ(sequences.size(), 6U);
  for (const fs::path& sequence : sequences) {
    const auto frames = ReadAll(sequence);
    const auto expected = ReadAll(Path("files") / sequence.lexically_relative(Path("bags")));
    ASSERT_EQ(frames.size(), expected.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_EQ(frames[i].frame.label, expected[i].frame.label);
      EXPECT_EQ(frames[i].frame.time_ns, expected[i].frame.time_ns);
    }
  }
  EXPECT_THAT(FaultsOf("bags"), IsEmpty());
}

// All clouds are there.
TEST_P(DatasetOfBags, IsNotMergedWithAChangedBag) {
  Make("a", {1, 2});
  Make("b", {2, 2});
  const std::string name =
      GetParam() == std::string("mcap") ? "frames.mcap" : "rosbag2/metadata.yaml";
  const fs::path changed = Path("b/sequences/000/000001") / name;
  fs::resize_file(changed, fs::file_size(changed) - 1);
  EXPECT_THAT(MessageOf([&] {
                (void)MergeShards({Path("a"), Path("b")}, Path("merged"), [](auto, auto) {});
              }),
              HasSubstr(changed.string() + ": must have the hash "));
}

TEST_P(DatasetOfBags, IsNotWholeWithAStrangerBesideABag) {
  Make("set");
  WriteFileWhole(Path("set/sequences/000/000001/frames.mcap.old"), "x");
  EXPECT_THAT(FaultsOf("set"),
              ElementsAre(Path("set/sequences/000/000001/frames.mcap.old").string() +
                          ": belongs to no sequence of the scenario"));
}

}  // namespace
}  // namespace railcast
