#include "railcast/scenario.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace railcast {
namespace {

ScenarioSources LidarFromAFile() {
  ScenarioSources sources;
  sources.Add("", "demo.json", "");
  sources.Add("/lidar", "sensors/vlp16.json", "");
  sources.Add("/lidar/mount", "demo.json", "/lidar/mount");
  sources.AddFile("/home/anna/rosette.csv", "rosette.csv");
  return sources;
}

TEST(ScenarioSources, NameTheFileThatAValueStandsIn) {
  const ScenarioSources sources = LidarFromAFile();
  EXPECT_EQ(sources.Place("/seed"), "demo.json: /seed");
  EXPECT_EQ(sources.Place("/lidar/scan/rate_hz"), "sensors/vlp16.json: /scan/rate_hz");
  EXPECT_EQ(sources.Place("/lidar/mount/yaw_deg"), "demo.json: /lidar/mount/yaw_deg");
  EXPECT_EQ(sources.Place("/lidar"), "sensors/vlp16.json");
}

TEST(ScenarioSources, DoNotMistakeAKeyForOneThatItBeginsWith) {
  EXPECT_EQ(LidarFromAFile().Place("/lidar2/scan"), "demo.json: /lidar2/scan");
}

std::string Located(const Fault& fault, std::string_view resolved_pointer) {
  return LidarFromAFile().Locate(fault, resolved_pointer).Line();
}

TEST(ScenarioSources, LocateABuildersPointerInItsFile) {
  EXPECT_EQ(Located({"/pattern/columns", "must be > 0", "0"}, "/lidar/scan"),
            "sensors/vlp16.json: /scan/pattern/columns: must be > 0 (got 0)");
}

TEST(ScenarioSources, ShowAFileAsTheUserKnowsIt) {
  EXPECT_EQ(Located({"/home/anna/rosette.csv:3", "must have 3 values", ""}, "/lidar/scan"),
            "rosette.csv:3: must have 3 values");
  EXPECT_EQ(Located({"/pattern: /home/anna/rosette.csv", "is empty", ""}, "/lidar/scan"),
            "sensors/vlp16.json: /scan/pattern: rosette.csv: is empty");
}

TEST(ScenarioSources, PutALineWithoutAPlaceWhereItsSpecStands) {
  EXPECT_EQ(Located({"", "labels: the table must hold \"rail\"", ""}, ""),
            "demo.json: labels: the table must hold \"rail\"");
}

TEST(ScenarioSources, LeaveThePointerWhereNothingWasRead) {
  EXPECT_EQ(ScenarioSources().Place("/world/tracks/0"), "/world/tracks/0");
}

TEST(ScenarioSources, ALibrarysFileIsNoPlaceOfOtherSections) {
  const ScenarioSpec spec = ReadScenario(std::filesystem::path(RAILCAST_SOURCE_DIR) /
                                         "scenarios/st_gallen_approach.json");
  EXPECT_NE(spec.sources.Place("/vehicle/motion").find("st_gallen_approach.json: /vehicle/motion"),
            std::string::npos);
  EXPECT_NE(spec.sources.Place("/labels/3/id").find("labels.json: /labels/3/id"),
            std::string::npos);
}

}  // namespace
}  // namespace railcast
