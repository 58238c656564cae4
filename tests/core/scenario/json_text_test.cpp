#include "core/scenario/json_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/scenario/malformed_case.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {
namespace {

// As ShownText() and RFC 6901 say, key by key.
std::string StepOfAnyKey(const std::string& key) {
  std::string step = "/";
  for (const char c : ShownText(key)) step += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return step;
}

TEST(PointerStep, ShowsWordsAsAnyKey) {
  for (const std::size_t length : {1U, 59U, 60U, 61U, 200U}) {
    for (const char last : std::string("a9_-Z/~ \n\x7f\xc3")) {
      const std::string key = std::string(length - 1, 'x') + last;
      EXPECT_EQ(PointerStep(key), StepOfAnyKey(key)) << key;
    }
  }
  EXPECT_EQ(PointerStep(""), "/");
  EXPECT_EQ(PointerStep("ridge_m/2"), "/ridge_m~12");
}

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

TEST_F(Override, AnObjectThatWasCopiedOutOfItsFileMayKeepItsVersion) {
  const std::filesystem::path base = ScenariosDir() / "minimal.json";
  const ScenarioSpec named = ReadOn(base, R"("weather": {"rain_rate_mmph": 4})");
  EXPECT_EQ(ReadOn(base, R"("weather": {"version": 1, "rain_rate_mmph": 4})"), named);
  const std::string vlp16 = ReadFileWhole(ScenariosDir() / "sensors/vlp16.json");
  EXPECT_EQ(ReadOn(base, R"("lidar": )" + vlp16).lidar.scan,
            ReadOn(base, R"("lidar": {"file": ")" +
                             (ScenariosDir() / "sensors/vlp16.json").string() + R"("})")
                .lidar.scan);
  EXPECT_THAT(MessageOf([&] { (void)ReadOn(base, R"("weather": {"version": 2})"); }),
              testing::HasSubstr("a.json: /weather/version: unknown key, must be "));
}

TEST_F(Override, SeveralSensorsTakeThePlaceOfOneAndBack) {
  const ScenarioSpec several = ReadOn(ScenariosDir() / "minimal.json",
                                      R"("lidars": [)" + Sensor("a") + ", " + Sensor("b") + "]");
  EXPECT_EQ(SensorNames(several), (std::vector<std::string>{"a", "b"}));
  const ScenarioSpec one = ReadOn(ScenariosDir() / "two_sensors.json",
                                  R"("interfaces": {"sensors": []}, "lidar": )" + Sensor("c"));
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

class MalformedFile : public testing::TestWithParam<MalformedCase> {};

TEST_P(MalformedFile, GivesExactlyTheExpectedLines) {
  std::filesystem::current_path(ScenariosDir());
  try {
    static_cast<void>(ReadScenario(GetParam().file));
    FAIL() << "expected InputError:\n" << GetParam().expected;
  } catch (const InputError& error) {
    EXPECT_EQ(error.what() + std::string("\n"), GetParam().expected);
  }
}

// Nothing that reads it may recurse as deep as it is nested.
TEST(DeepScenario, Of200000LevelsIsRefused) {
  const TemporaryFolder folder;
  constexpr std::size_t kLevels = 200'000;
  const std::string lists = std::string(kLevels, '[') + std::string(kLevels, ']');
  std::string objects;
  for (std::size_t i = 0; i < kLevels; ++i) objects += "{\"world\":";
  for (const std::string& text :
       {"{\"version\": 1, \"world\": " + lists + "}", objects + "1" + std::string(kLevels, '}')}) {
    const auto file = folder.Write("deep.json", text);
    EXPECT_EQ(CheckScenario(file),
              std::vector<std::string>{file.string() + ": nested deeper than 64 levels"});
  }
}

INSTANTIATE_TEST_SUITE_P(Scenarios,
                         MalformedFile,
                         testing::ValuesIn(MalformedCases("read")),
                         [](const auto& test) { return NameOf(test.param); });

}  // namespace
}  // namespace railcast
