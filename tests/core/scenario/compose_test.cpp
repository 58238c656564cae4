#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/rail/line/line_place.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"
#include "tests/core/io/message_of.h"
#include "tests/core/scenario/malformed_case.h"
#include "tests/core/scenario/scenario_files.h"
#include "tests/support/scan_once.h"

namespace railcast {
namespace {

TEST(CheckScenario, FindsNoFaultInAnyShippedScenario) {
  for (const auto& file : ShippedScenarios()) {
    EXPECT_EQ(CheckScenario(file), std::vector<std::string>{}) << file;
  }
}

TEST(CheckScenario, ReportsThePatternAndTheWorldTogether) {
  const TemporaryFolder folder;
  const auto file = folder.Write("two.json", R"({
    "version": 1,
    "file": ")" + (ScenariosDir() / "minimal.json").string() +
                                                 R"(",
    "lidar": {"scan": {"rate_hz": 10, "pattern": {"type": "raster", "horizontal_fov_deg": 60,
      "vertical_fov_deg": 30, "angular_resolution_deg": 0.7}}},
    "world": {"alignment": {"course": {"type": "sections", "length_m": 9,
      "sections": [{"s_m": 3}]}}}
  })");
  const std::vector<std::string> faults = CheckScenario(file);
  ASSERT_EQ(faults.size(), 3U);
  EXPECT_TRUE(faults[0].starts_with(file.string() + ": /lidar/scan/pattern/horizontal_fov_deg: "));
  EXPECT_TRUE(faults[1].starts_with(file.string() + ": /lidar/scan/pattern/vertical_fov_deg: "));
  EXPECT_TRUE(faults[2].starts_with(file.string() + ": /world/alignment/course/sections/0/s_m: "));
}

TEST(CheckScenario, NamesTheExtraThatASurveyNeeds) {
  const TemporaryFolder folder;
  static_cast<void>(folder.Write("scene.survey", "any bytes"));
  const auto file = folder.Write(
      "a.json", R"({"version": 1, "file": ")" +
                    (ScenariosDir() / "malformed/parts/sound.json").string() + R"(", "world": {
    "alignment": {"course": {"type": "elements",
                             "elements": [{"type": "straight", "length_m": 1000}]}},
    "survey": "scene.survey"}})");
  const std::vector<std::string> faults = CheckScenario(file);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_TRUE(faults[0].starts_with(file.string() + ": /world/survey: ")) << faults[0];
  EXPECT_NE(faults[0].find("scene.survey: needs the extra survey"), std::string::npos) << faults[0];
}

TEST(MakeSimulator, PutsTheSensorWhereTheMountSays) {
  ScenarioSpec spec = ReadScenario(ScenariosDir() / "minimal.json");
  spec.lidar.mount.position_m = {2.0, 0.5, 3.0};
  spec.lidar.mount.yaw_deg = 90.0;
  const auto simulator = MakeSimulator(spec, 1);
  const Transform vehicle_from_sensor =
      simulator->world().WorldFromVehicle(0).inverse() * simulator->WorldFromSensor(0);
  // World positions reach 1e3 m, where a double's step is 1e-13 m; a few products add up.
  constexpr double kRoundOff_m = 1e-11;
  EXPECT_LT((vehicle_from_sensor.translation() - Vector3(2.0, 0.5, 3.0)).norm(), kRoundOff_m);
  EXPECT_LT((vehicle_from_sensor.linear() * Vector3::UnitX() - Vector3::UnitY()).norm(),
            kRoundOff_m);
}

TEST(MakeSimulator, NamesTheFileWhoseEffectsDoNotFitAnotherRung) {
  const TemporaryFolder folder;
  const auto file = folder.Write("a.json", R"({"version": 1, "file": ")" +
                                               (ScenariosDir() / "minimal.json").string() +
                                               R"(", "effects": {"rain": true}})");
  ScenarioSpec spec = ReadScenario(file);
  spec.fidelity = Fidelity::kSurface;
  EXPECT_EQ(MessageOf([&] { static_cast<void>(MakeSimulator(spec, 1)); }),
            file.string() +
                R"(: /effects: "rain" of the published model and "surface_response" of physics )"
                "must not both be on");
}

/// Intensities of the returned points, by label.
std::map<std::string, std::vector<float>> IntensitiesByLabel(const ScenarioSpec& spec) {
  std::map<std::string, std::vector<float>> intensities;
  const Frame frame = FrameBy(*MakeSimulator(spec, 0));
  for (const Label& label : spec.labels) {
    for (std::size_t i = 0; i < frame.label.size(); ++i) {
      if (frame.label[i] != label.id || frame.outcome[i] != Outcome::kReturned) continue;
      intensities[label.name].push_back(frame.intensity[i]);
    }
  }
  return intensities;
}

float MedianIntensity(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

TEST(LevelCrossingScene, ShowsAllThatStandsAlongIt) {
  const auto seen = IntensitiesByLabel(ReadScenario(ScenariosDir() / "level_crossing.json"));
  for (const char* label : {"signal", "board", "balise", "relay_box", "building", "road",
                            "level_crossing", "furniture", "person", "road_vehicle"}) {
    EXPECT_TRUE(seen.contains(label)) << label;
  }
}

/// White sheeting has 570 times the answer of a white Lambertian, everything else at most 1.
TEST(LevelCrossingScene, ShowsItsBoardsAHundredTimesAsBrightAsAllElse) {
  const auto seen = IntensitiesByLabel(ReadScenario(ScenariosDir() / "level_crossing.json"));
  const float boards = MedianIntensity(seen.at("board"));
  EXPECT_GT(boards, 100.0F);
  for (const auto& [label, intensities] : seen) {
    // At 200 m, half of what is seen of the buffer stop is its board.
    if (label == "board" || label == "buffer_stop") continue;
    EXPECT_LT(100.0F * MedianIntensity(intensities), boards) << label;
  }
}

class MalformedBuild : public testing::TestWithParam<MalformedCase> {};

TEST_P(MalformedBuild, GivesExactlyTheExpectedLines) {
  std::filesystem::current_path(ScenariosDir());
  std::string lines;
  for (const std::string& line : CheckScenario(GetParam().file)) lines += line + '\n';
  EXPECT_EQ(lines, GetParam().expected);
}

INSTANTIATE_TEST_SUITE_P(Scenarios,
                         MalformedBuild,
                         testing::ValuesIn(MalformedCases("build")),
                         [](const auto& test) { return NameOf(test.param); });

/// The JSON that follows a line of docs/scenario.md.
std::string ExampleAfter(const std::string& line) {
  const std::string page = TextOf(std::filesystem::path(RAILCAST_SOURCE_DIR) / "docs/scenario.md");
  const std::string fence = line + "\n```json\n";
  const std::size_t begin = page.find(fence);
  if (begin == std::string::npos) return {};
  const std::size_t end = page.find("```", begin + fence.size());
  return page.substr(begin + fence.size(), end - begin - fence.size());
}

TEST(ScenarioPage, PlacesItsObjectsOnTheMapOfSanktPoelten) {
  const std::string scenario =
      R"({"version": 1, "file": "line.json", "world": {"file": "westbahn-130-01.world.json",)" +
      ExampleAfter("<!-- example: on the map of osm_sankt_poelten/line.json -->") + "}}";
  const auto world = MakeWorld(
      ReadScenarioText(scenario, ScenariosDir() / "osm_sankt_poelten" / "with_objects.json"));
  const auto beside = [&](std::size_t object, std::int64_t time_ns) {
    return PlaceOnLine(world->alignment(), world->WorldFromObject(object, time_ns).translation(),
                       500.0);
  };
  // 1e-7 degrees are 1.1 cm of latitude.
  EXPECT_NEAR(beside(0, 0).s_m, 500.0, 0.01);
  EXPECT_NEAR(beside(0, 0).d_m, -6.0, 0.01);
  EXPECT_NEAR(beside(0, 600 * kNsPerS).d_m, 6.0, 0.01);
  EXPECT_NEAR(beside(1, 0).s_m, 650.0, 0.1);
  EXPECT_NEAR(beside(1, 0).d_m, 0.0, 1e-3);
}

}  // namespace
}  // namespace railcast
