#include <gtest/gtest.h>

#include "core/scenario/scenario.h"
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
  EXPECT_EQ(spec.interfaces.udp, std::vector<std::string>{"127.0.0.1:2368"});
}

TEST(PublishedFiles, GiveRainAsAnIntensityOfFiftyMillimetresAnHour) {
  const ScenarioSpec spec = ReadScenario(ScenariosDir() / "published_files.json");
  EXPECT_DOUBLE_EQ(spec.weather.rain_rate_mmph, 0.1 * 50.0);
}

TEST(PublishedFiles, KeepTheCameraAsItIs) {
  const ScenarioSpec spec = ReadScenario(ScenariosDir() / "published_files.json");
  EXPECT_EQ(spec.camera,
            R"({"version":1,"width_px":1920,"height_px":1080,"horizontal_fov_deg":60})");
}

}  // namespace
}  // namespace railcast
