#include <gtest/gtest.h>

#include "railcast/scenario.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {
namespace {

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

}  // namespace
}  // namespace railcast
