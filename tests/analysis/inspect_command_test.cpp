#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/io/write_file.h"
#include "tests/analysis/analyze_program.h"

namespace railcast {
namespace {

using testing::HasSubstr;

/// Two points without rings.
std::string WriteCloud(const TemporaryFolder& folder) {
  return folder
      .Write("cloud.pcd",
             "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\n"
             "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n1 2 3\n4 5 6\n")
      .string();
}

TEST(InspectCommand, EndsWithStatusOneWhereTheRecordingIsNotFitForTheJob) {
  const TemporaryFolder folder;
  const std::string cloud = WriteCloud(folder);
  const Ended fit = Analyze("inspect " + cloud + " --format text --for view");
  EXPECT_EQ(fit.status, 0) << fit.said;
  const Ended unfit = Analyze("inspect " + cloud + " --format text --for weather");
  EXPECT_EQ(unfit.status, 1);
  EXPECT_THAT(unfit.said,
              HasSubstr("cloud.pcd: is not fit for weather: its firings are not known"));
  const Ended unknown = Analyze("inspect " + cloud + " --format text --for dinner");
  EXPECT_EQ(unknown.status, 2);
}

TEST(InspectCommand, WritesAPageAndJson) {
  const TemporaryFolder folder;
  const std::string cloud = WriteCloud(folder);
  const std::filesystem::path out = std::filesystem::path(cloud).parent_path() / "out";
  const Ended run = Analyze("inspect " + cloud + " --out " + out.string());
  ASSERT_EQ(run.status, 0) << run.said;
  EXPECT_TRUE(exists(out / "report.html"));
  const nlohmann::json report = nlohmann::json::parse(ReadFileWhole(out / "inspect.json"));
  EXPECT_EQ(report.at("sections").at(0).at("key"), "jobs");
  EXPECT_TRUE(report.at("remarks").is_array());
}

TEST(InspectCommand, TellsTheSensorOfACloudThatAnotherDecoderMade) {
  const std::string cloud = RAILCAST_SHARED_DATA_DIR "/lidar_hesai_more/40p_decoded.pcd";
  if (!std::filesystem::exists(cloud)) GTEST_SKIP() << cloud << " is not there";
  const Ended run = Analyze("inspect " + cloud + " --format text");
  ASSERT_EQ(run.status, 0) << run.said;
  EXPECT_THAT(run.said, HasSubstr("Pandar40P"));
}

}  // namespace
}  // namespace railcast
