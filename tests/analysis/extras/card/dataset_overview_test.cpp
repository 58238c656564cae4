#include "analysis/extras/card/dataset_overview.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numeric>
#include <set>
#include <string>

#include "core/io/content_hash.h"
#include "core/io/run/run_record.h"
#include "core/io/write_file.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/dataset/dataset_project.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

/// A data set of two scenarios, made once.
class DatasetOverviewTest : public testing::Test {
 protected:
  void SetUp() override {
    nlohmann::json recipe = ProjectRecipe();
    recipe["num_scenarios"] = 2;
    (void)MakeDataset(ReadProjectRecipe(directory_.path() / "project", recipe), Path());
  }
  [[nodiscard]] fs::path Path(const std::string& name = "") const {
    const fs::path set = directory_.path() / "set";
    return name.empty() ? set : set / name;
  }
  /// Writes report.json, and its hash to manifest.json.
  void ReplaceReport(const std::string& report) const {
    WriteFileWhole(Path("report.json"), report);
    OrderedJson manifest = OrderedJson::parse(ReadFileWhole(Path("manifest.json")));
    manifest["files_xxh3"]["report.json"] = ContentHash(report);
    manifest.erase("manifest_xxh3");
    WriteFileWhole(Path("manifest.json"), WithManifestHash(manifest.dump(2) + "\n"));
  }
  /// The message about a report with another value at a pointer, without the file's name.
  [[nodiscard]] std::string MessageWith(const std::string& pointer,
                                        const OrderedJson& value) const {
    const std::string original = ReadFileWhole(Path("report.json"));
    OrderedJson report = OrderedJson::parse(original);
    report[OrderedJson::json_pointer(pointer)] = value;
    ReplaceReport(report.dump());
    const std::string message = MessageOf([&] { (void)ReadDatasetOverview(Path()); });
    ReplaceReport(original);
    const std::string begin = Path("report.json").string() + ": ";
    EXPECT_EQ(message.substr(0, begin.size()), begin);
    return message.substr(std::min(begin.size(), message.size()));
  }
  TemporaryDirectory directory_;
};

// The index is written line by line, without the report's sums.
TEST_F(DatasetOverviewTest, AgreesWithTheIndex) {
  const DatasetOverview overview = ReadDatasetOverview(Path());
  std::uint64_t frames = 0, points = 0, in_frames = 0, near = 0, without_objects = 0;
  std::set<std::string> persons;
  std::ifstream lines(Path("index.jsonl"));
  for (std::string text; std::getline(lines, text); ++frames) {
    const OrderedJson line = OrderedJson::parse(text);
    points += line["points"].get<std::uint64_t>();
    bool has_points = false;
    for (const OrderedJson& object : line["objects"]) {
      has_points = has_points || object["points"] > 0;
      if (object["type"] != "person") continue;
      ++in_frames;
      near += object["distance_m"] < 10.0 ? 1 : 0;
      persons.insert(line["scenario"].dump() + object["name"].dump());
    }
    without_objects += has_points ? 0 : 1;
  }
  EXPECT_EQ(overview.num_scenarios, 2U);
  const DatasetReportRecord& report = overview.report;
  EXPECT_EQ(report.num_frames, frames);
  EXPECT_EQ(report.counts.points, points);
  EXPECT_EQ(report.frames_without_objects, without_objects);
  ASSERT_TRUE(report.objects.contains("person"));
  const TypeCountsRecord& person = report.objects.at("person");
  EXPECT_EQ(person.objects, persons.size());
  EXPECT_EQ(person.in_frames, in_frames);
  EXPECT_EQ(person.by_distance[0], near);
  EXPECT_EQ(std::accumulate(person.by_occlusion.begin(), person.by_occlusion.end(), std::size_t{0}),
            in_frames);
}

TEST_F(DatasetOverviewTest, RefusesAReportThatChangedSinceItWasWritten) {
  const std::string report = ReadFileWhole(Path("report.json"));
  WriteFileWhole(Path("report.json"), report + "\n");
  EXPECT_EQ(MessageOf([&] { (void)ReadDatasetOverview(Path()); }),
            Path("report.json").string() + ": must have the hash " + ContentHash(report) +
                ", as manifest.json says (got " + ContentHash(report + "\n") + ")");
}

TEST_F(DatasetOverviewTest, RefusesAReportThatIsNone) {
  ReplaceReport("[");
  EXPECT_THAT(MessageOf([&] { (void)ReadDatasetOverview(Path()); }),
              testing::StartsWith(Path("report.json").string() + ": is damaged: line 1, column "));
}

TEST_F(DatasetOverviewTest, RefusesNumbersThatDoNotFit) {
  EXPECT_EQ(MessageWith("/mine", 1).substr(0, 18), "/mine: unknown key");
  EXPECT_EQ(MessageWith("/duplicate_frames", 7), "/duplicate_frames: must be <= 6 (got 7)");
  EXPECT_THAT(MessageWith("/splits/train/frames", 5),
              testing::StartsWith("/splits: must sum up to 6 (got {\"train\":"));
  EXPECT_THAT(MessageWith("/num_frames", 5), testing::EndsWith("must be <= 5 (got 6)"));
  EXPECT_EQ(MessageWith("/weathers", OrderedJson::object()),
            "/weathers: must sum up to 2 (got {})");
  EXPECT_THAT(MessageWith("/objects/person/by_occlusion/far", 0),
              testing::StartsWith("/objects/person/by_occlusion/far: unknown key, must be "));
  EXPECT_THAT(MessageWith("/objects/person/with_points", 100),
              testing::MatchesRegex("/objects/person/with_points: must be <= [0-9]+ .got 100."));
  EXPECT_THAT(MessageWith("/points", -1), testing::HasSubstr("must be a whole number from 0"));
}

}  // namespace
}  // namespace railcast
