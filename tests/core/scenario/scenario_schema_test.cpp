#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "railcast/scenario.h"
#include "tests/core/scenario/scenario_files.h"
#include "tests/core/scenario/scenario_schema.h"

namespace railcast {
namespace {

// After a change of a spec's description, regenerate the schemas with
//   RAILCAST_WRITE_SCHEMAS=1 build/release/tests/core/core_tests
//     --gtest_filter='ScenarioSchemas.*'
TEST(ScenarioSchemas, ArePublishedAsTheReaderHasThem) {
  const auto folder = ScenariosDir() / "schema";
  for (const auto& [name, text] : ScenarioSchemas()) {
    if (std::getenv("RAILCAST_WRITE_SCHEMAS") != nullptr) std::ofstream(folder / name) << text;
    EXPECT_EQ(TextOf(folder / name), text) << name;
  }
  EXPECT_EQ(JsonFilesIn(folder).size(), ScenarioSchemas().size());
}

TEST(PublishedFiles, MapOneToOneOntoTheSections) {
  const ScenarioSpec spec = ReadScenario(ScenariosDir() / "published_files.json");
  const auto& raster = std::get<RasterSpec>(spec.lidar.scan.pattern);
  EXPECT_EQ(raster.horizontal_fov_deg, 60.0);
  EXPECT_EQ(raster.vertical_fov_deg, 30.0);
  EXPECT_EQ(raster.angular_resolution_deg, 0.25);
  EXPECT_EQ(spec.lidar.scan.rate_hz, 10.0);
  EXPECT_EQ(spec.lidar.range_max_m, 300.0);
  EXPECT_EQ(spec.weather.fog_density_per_m, 0.001);
}

TEST(PublishedFiles, GiveRainAsAnIntensityOfFiftyMillimetresAnHour) {
  const ScenarioSpec spec = ReadScenario(ScenariosDir() / "published_files.json");
  EXPECT_DOUBLE_EQ(spec.weather.rain_rate_mmph, 0.1 * 50.0);
}

TEST(PublishedFiles, SayWhatTheCameraIs) {
  const ScenarioSpec spec = ReadScenario(ScenariosDir() / "published_files.json");
  EXPECT_EQ(spec.camera, (CameraSpec{1920, 1080, 60.0}));
}

// On a Velodyne sensor's port, programs that do not know the railcast protocol would receive it.
TEST(PublishedFiles, SendTheProtocolToItsOwnPort) {
  const ScenarioSpec spec = ReadScenario(ScenariosDir() / "published_files.json");
  EXPECT_EQ(spec.interfaces.protocol, Protocol::kRailcast);
  EXPECT_EQ(spec.interfaces.udp, std::vector<std::string>{"127.0.0.1:27400"});
}

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
