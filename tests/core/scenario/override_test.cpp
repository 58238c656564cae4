#include <gtest/gtest.h>

#include <string>

#include "core/base/error.h"
#include "railcast/scenario.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {
namespace {

// A key that is an alternative to a key of a base file replaces that key.
class Override : public testing::Test {
 protected:
  /// Reads a scenario based on minimal.json whose weather is based on another file.
  [[nodiscard]] ScenarioSpec ReadWeather(const std::string& base, const std::string& own) const {
    folder_.Write("weather.json", R"({"version": 1, )" + base + "}");
    return ReadOn(ScenariosDir() / "minimal.json",
                  R"("weather": {"file": "weather.json", )" + own + "}");
  }
  /// Reads a scenario based on `base`.
  [[nodiscard]] ScenarioSpec ReadOn(const std::filesystem::path& base,
                                    const std::string& own) const {
    return ReadScenario(folder_.Write(
        "a.json", R"({"version": 1, "file": ")" + base.string() + R"(", )" + own + "}"));
  }
  [[nodiscard]] std::string Sensor(const std::string& name) const {
    return R"({"file": ")" + (ScenariosDir() / "sensors/vlp16.json").string() + R"(", "name": ")" +
           name + R"("})";
  }

  TemporaryFolder folder_;
};

TEST_F(Override, RainIntensityTakesThePlaceOfTheRainRate) {
  EXPECT_EQ(
      ReadWeather(R"("rain_rate_mmph": 4)", R"("rain_intensity": 0.5)").weather.rain_rate_mmph,
      25.0);
  EXPECT_EQ(
      ReadWeather(R"("rain_intensity": 0.5)", R"("rain_rate_mmph": 4)").weather.rain_rate_mmph,
      4.0);
}

TEST_F(Override, VisibilityTakesThePlaceOfTheFogDensity) {
  const WeatherSpec clear =
      ReadWeather(R"("fog_density_per_m": 0.02)", R"("visibility_m": 100)").weather;
  EXPECT_EQ(clear.visibility_m, 100.0);
  EXPECT_EQ(clear.fog_density_per_m, 0.0);
  const WeatherSpec dense =
      ReadWeather(R"("visibility_m": 100)", R"("fog_density_per_m": 0.02)").weather;
  EXPECT_EQ(dense.visibility_m, std::nullopt);
  EXPECT_EQ(dense.fog_density_per_m, 0.02);
}

TEST_F(Override, SeveralSensorsTakeThePlaceOfOneAndBack) {
  const ScenarioSpec several = ReadOn(ScenariosDir() / "minimal.json",
                                      R"("lidars": [)" + Sensor("a") + ", " + Sensor("b") + "]");
  EXPECT_EQ(SensorNames(several), (std::vector<std::string>{"a", "b"}));
  const ScenarioSpec one =
      ReadOn(ScenariosDir() / "two_sensors.json", R"("interfaces": {}, "lidar": )" + Sensor("c"));
  EXPECT_EQ(SensorNames(one), std::vector<std::string>{"c"});
}

TEST_F(Override, TheNearestFileDecidesWhereSeveralBuildOnEachOther) {
  folder_.Write("far.json", R"({"version": 1, "rain_intensity": 1})");
  const ScenarioSpec spec =
      ReadWeather(R"("file": "far.json", "rain_rate_mmph": 4)", R"("wetness": 1)");
  EXPECT_EQ(spec.weather.rain_rate_mmph, 4.0);
}

TEST_F(Override, BothInOneFileAreAConflictAlsoInTheBase) {
  try {
    static_cast<void>(
        ReadWeather(R"("rain_rate_mmph": 4, "rain_intensity": 0.5)", R"("wetness": 1)"));
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    const std::string line = error.what();
    EXPECT_TRUE(line.ends_with(
        "weather.json: /rain_intensity: must not be given together with \"rain_rate_mmph\" (got "
        "0.5)"))
        << line;
  }
}

}  // namespace
}  // namespace railcast
