#include "core/extras/recipe/scenario_draw.h"
#include "core/io/record/record_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "core/rail/world/gauge_entries.h"
#include "core/scene/object_contacts.h"
#include "railcast/rail_world.h"
#include "tests/core/extras/recipe/drawn_value.h"
#include "tests/core/extras/recipe/recipe_project.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

using testing::HasSubstr;

/// The scenarios of a recipe, as resolved.
std::vector<DrawnScenario> DrawAll(const Recipe& recipe) {
  const ScenarioDrawer drawer(recipe);
  std::vector<DrawnScenario> scenarios;
  for (std::uint32_t i = 0; i < recipe.num_scenarios; ++i) scenarios.push_back(drawer.Draw(i));
  return scenarios;
}

TEST(ScenarioDraw, DependsOnTheRecipeAndTheNumberAlone) {
  const TemporaryDirectory directory;
  const Recipe recipe = ReadProjectRecipe(directory.path(), ProjectRecipe());
  const std::vector<DrawnScenario> all = DrawAll(recipe);
  const ScenarioDrawer drawer(recipe);
  EXPECT_EQ(drawer.Draw(4).scenario, all[4].scenario);
  EXPECT_EQ(RecordText(drawer.Draw(4).record), RecordText(all[4].record));
  std::set<double> rains_mmph;
  for (const DrawnScenario& drawn : all) rains_mmph.insert(drawn.scenario.weather.rain_rate_mmph);
  EXPECT_EQ(rains_mmph.size(), all.size());
}

TEST(ScenarioDraw, AnotherKeyMovesNoOtherDraw) {
  const TemporaryDirectory directory;
  const std::vector<DrawnScenario> before =
      DrawAll(ReadProjectRecipe(directory.path(), ProjectRecipe()));
  nlohmann::json more = ProjectRecipe();
  more["draws"]["/weather/wind_speed_mps"] = {{"type", "uniform"}, {"min", 1}, {"max", 9}};
  more["groups"] = nlohmann::json::parse(
      R"([{"name": "track", "options": [{"name": "bare"}, {"name": "full", "set": {"/world/terrain/has_ditches": true}}]}])");
  more["objects"].push_back(nlohmann::json::parse(R"({
    "name": "deer", "count": {"type": "choice", "values": [1]}, "object": {"type": "deer", "d_m": 12},
    "ahead_m": {"type": "uniform", "min": 60, "max": 90}})"));
  const std::vector<DrawnScenario> after = DrawAll(ReadProjectRecipe(directory.path(), more));
  for (std::size_t i = 0; i < before.size(); ++i) {
    ScenarioSpec changed = after[i].scenario;
    EXPECT_GE(changed.weather.wind_speed_mps, 1.0);
    EXPECT_EQ(changed.world.objects.back().name, "deer/1");
    changed.weather.wind_speed_mps = before[i].scenario.weather.wind_speed_mps;
    changed.world.objects.pop_back();
    changed.world.terrain.has_ditches = before[i].scenario.world.terrain.has_ditches;
    EXPECT_EQ(changed, before[i].scenario);
  }
}

TEST(ScenarioDraw, ValuesOfAGroupComeTogether) {
  const TemporaryDirectory directory;
  nlohmann::json recipe = ProjectRecipe();
  recipe["num_scenarios"] = 20;
  recipe["draws"] = nlohmann::json::object();
  recipe["objects"] = nlohmann::json::array();
  recipe["groups"] = nlohmann::json::parse(R"([{"name": "weather", "options": [
    {"name": "dry", "set": {"/weather/wetness": 0}},
    {"name": "wet", "set": {"/weather/wetness": 1},
     "draws": {"/weather/rain_rate_mmph": {"type": "uniform", "min": 3, "max": 9}}}]}])");
  std::map<std::string, int> counts;
  for (const DrawnScenario& drawn : DrawAll(ReadProjectRecipe(directory.path(), recipe))) {
    const std::string option = DrawnOf(drawn.record, "weather");
    ++counts[option];
    EXPECT_EQ(drawn.scenario.weather.wetness, option == "wet" ? 1.0 : 0.0);
    EXPECT_EQ(drawn.scenario.weather.rain_rate_mmph >= 3.0, option == "wet");
  }
  EXPECT_EQ(counts.size(), 2U);
}

TEST(ScenarioDraw, PlacedObjectsMeetNothing) {
  const TemporaryDirectory directory;
  nlohmann::json recipe = ProjectRecipe();
  recipe["objects"][0]["count"] = {{"type", "choice"}, {"values", {12}}};
  recipe["objects"][0]["ahead_m"] = {{"type", "uniform"}, {"min", 5}, {"max", 9}};
  bool was_any_drawn_again = false;
  for (const DrawnScenario& drawn : DrawAll(ReadProjectRecipe(directory.path(), recipe))) {
    EXPECT_EQ(drawn.scenario.world.objects.size(), 13U);
    const auto world = MakeWorld(drawn.scenario);
    EXPECT_TRUE(ContactFinder(*world).FindAll(0).empty());
    for (const Json& placed : drawn.record.placed) {
      was_any_drawn_again = was_any_drawn_again || placed.at("attempt") != 1;
    }
  }
  EXPECT_TRUE(was_any_drawn_again);
}

TEST(ScenarioDraw, PlacedObjectsKeepToTheRuleAboutTheGauge) {
  const TemporaryDirectory directory;
  for (const std::string rule : {"clear", "foul"}) {
    nlohmann::json recipe = ProjectRecipe();
    recipe["objects"][0]["gauge"] = rule;
    recipe["objects"][0]["count"] = {{"type", "choice"}, {"values", {3}}};
    for (const DrawnScenario& drawn : DrawAll(ReadProjectRecipe(directory.path(), recipe))) {
      const auto world = MakeWorld(drawn.scenario);
      for (std::size_t i = 1; i < drawn.scenario.world.objects.size(); ++i) {
        const bool is_in = !FindObjectInTheWay(drawn.scenario.world, *world, i, false, 0).empty();
        EXPECT_EQ(is_in, rule == "foul") << drawn.scenario.world.objects[i].d_m;
      }
    }
  }
}

TEST(ScenarioDraw, PlacedObjectsStandInNoStructure) {
  const TemporaryDirectory directory;
  nlohmann::json recipe = ProjectRecipe();
  recipe["set"]["/world/structures"] = nlohmann::json::parse(R"([
    {"type": "noise_wall", "name": "wall", "side": "left", "begin_s_m": 300, "end_s_m": 700}])");
  const double in_the_wall_m = 3.85;
  nlohmann::json& d_m = recipe["objects"][0]["draws"]["/d_m"];
  d_m = {{"type", "choice"}, {"values", {in_the_wall_m, 6.0}}};
  bool was_any_drawn_again = false;
  for (const DrawnScenario& drawn : DrawAll(ReadProjectRecipe(directory.path(), recipe))) {
    for (const Json& placed : drawn.record.placed) {
      EXPECT_EQ(placed.at("drawn").at("/d_m"), 6.0);
      was_any_drawn_again = was_any_drawn_again || placed.at("attempt") != 1;
    }
  }
  EXPECT_TRUE(was_any_drawn_again);
  d_m["values"] = {in_the_wall_m};
  const Recipe nowhere = ReadProjectRecipe(directory.path(), recipe);
  EXPECT_THAT(MessageOf([&] { (void)ScenarioDrawer(nowhere).Draw(0); }),
              HasSubstr("at the last one it is in \"noise_wall\" of the line in frame 0"));
}

TEST(ScenarioDraw, SaysWhatFindsNoPlace) {
  const TemporaryDirectory directory;
  nlohmann::json recipe = ProjectRecipe();
  recipe["objects"][0]["draws"]["/d_m"] = {{"type", "uniform"}, {"min", -0.1}, {"max", 0.1}};
  recipe["objects"][0]["gauge"] = "clear";
  const Recipe read = ReadProjectRecipe(directory.path(), recipe);
  const std::string file = (directory.path() / "recipe.json").string();
  EXPECT_EQ(MessageOf([&] { (void)ScenarioDrawer(read).Draw(2); }),
            file +
                ": /objects/0: scenario 2: no place for \"person/1\" in 100 attempts; at the "
                "last one it is in the gauge of track \"main\" in frame 0");
}

TEST(ScenarioDraw, SaysWhyTheVehicleCannotStart) {
  const TemporaryDirectory directory;
  nlohmann::json recipe = ProjectRecipe();
  recipe["start_s_m"] = {{"type", "uniform"}, {"min", 2000}, {"max", 3000}};
  const Recipe read = ReadProjectRecipe(directory.path(), recipe);
  EXPECT_THAT(MessageOf([&] { (void)ScenarioDrawer(read).Draw(0); }),
              HasSubstr("/start_s_m: scenario 0: no start in 100 attempts; at the last one: "));
}

TEST(ScenarioDraw, ChainagesOfAPlacedMotionCountFromTheObject) {
  const TemporaryDirectory directory;
  nlohmann::json recipe = ProjectRecipe();
  recipe["objects"][0]["object"]["motion"] = nlohmann::json::parse(
      R"({"path": {"speed_mps": 1.5, "start_at_vehicle_s_m": -30, "points": [{"s_m": 2, "d_m": 9}]}})");
  for (const DrawnScenario& drawn : DrawAll(ReadProjectRecipe(directory.path(), recipe))) {
    const ObjectSpec& person = drawn.scenario.world.objects.at(1);
    const PathSpec& path = person.motion.value().path.value();
    EXPECT_DOUBLE_EQ(path.points.at(0).s_m.value(), person.s_m + 2.0);
    EXPECT_DOUBLE_EQ(path.start_at_vehicle_s_m.value(), person.s_m - 30.0);
  }
}

/// How many of the scenarios are in each part.
std::map<std::string, int> NumInParts(const std::vector<DrawnScenario>& scenarios) {
  std::map<std::string, int> num;
  for (const DrawnScenario& drawn : scenarios) {
    ++num[drawn.record.split];
  }
  return num;
}

TEST(ScenarioDraw, PartsByPlaceHoldTheirSharesAndSeeNoCommonGround) {
  const TemporaryDirectory directory;
  nlohmann::json recipe = ProjectRecipe();
  recipe["num_scenarios"] = 80;
  recipe["num_frames"] = 1;
  recipe["objects"] = nlohmann::json::array();
  recipe["start_s_m"] = {{"type", "uniform"}, {"min", 100}, {"max", 900}};
  recipe["split"] = {{"by", "place"}, {"cell_m", 150}, {"sight_m", 50},
                     {"train", 0.7},  {"val", 0.15},   {"test", 0.15}};
  const std::vector<DrawnScenario> all = DrawAll(ReadProjectRecipe(directory.path(), recipe));
  EXPECT_EQ(NumInParts(all),
            (std::map<std::string, int>{{"train", 56}, {"val", 12}, {"test", 12}}));
  for (const DrawnScenario& one : all) {
    for (const DrawnScenario& other : all) {
      if (one.record.split == other.record.split) continue;
      const auto& a = one.record.seen_s_m;
      const auto& b = other.record.seen_s_m;
      EXPECT_TRUE(a[1] < b[0] || b[1] < a[0]);
    }
  }
}

TEST(ScenarioDraw, ALongRunKeepsToItsPart) {
  const TemporaryDirectory directory;
  nlohmann::json recipe = ProjectRecipe();
  recipe["num_scenarios"] = 10;
  recipe["num_frames"] = 2;
  recipe["stride"] = 50;
  recipe["objects"] = nlohmann::json::array();
  // 20 m/s for 5 s, of which no start knows before a world was made.
  recipe["set"]["/vehicle/motion"] = {{"profile", {{{"time_s", 0}, {"speed_mps", 20}}}}};
  recipe["start_s_m"] = {{"type", "uniform"}, {"min", 100}, {"max", 800}};
  recipe["split"] = {{"by", "place"}, {"cell_m", 250}, {"sight_m", 20},
                     {"train", 0.6},  {"val", 0.2},    {"test", 0.2}};
  const std::vector<DrawnScenario> all = DrawAll(ReadProjectRecipe(directory.path(), recipe));
  EXPECT_EQ(NumInParts(all), (std::map<std::string, int>{{"train", 6}, {"val", 2}, {"test", 2}}));
  for (const DrawnScenario& drawn : all) {
    const auto& seen_s_m = drawn.record.seen_s_m;
    EXPECT_NEAR(seen_s_m[1] - seen_s_m[0], 140.0, 1e-9);
  }
}

TEST(ScenarioDraw, AllScenariosOfALineAreInOnePart) {
  const TemporaryDirectory directory;
  nlohmann::json recipe = ProjectRecipe();
  recipe["num_scenarios"] = 20;
  recipe["objects"] = nlohmann::json::array();
  recipe["bases"] = nlohmann::json::array();
  for (const int length_m : {1000, 1100, 1200, 1300}) {
    nlohmann::json scenario = nlohmann::json::parse(ReadFileWhole(MakeProject(directory.path())));
    scenario["world"]["alignment"]["course"]["elements"][0]["length_m"] = length_m;
    const std::string name = "line_" + std::to_string(length_m) + ".json";
    WriteFileWhole(directory.path() / name, scenario.dump());
    recipe["bases"].push_back({{"file", name}});
  }
  recipe["bases"][1]["split"] = "val";
  recipe["split"] = {{"by", "line"}, {"train", 0.7}, {"val", 0.15}, {"test", 0.15}};
  const std::vector<DrawnScenario> all = DrawAll(ReadProjectRecipe(directory.path(), recipe));
  EXPECT_EQ(NumInParts(all), (std::map<std::string, int>{{"train", 14}, {"val", 3}, {"test", 3}}));
  std::map<std::string, std::set<std::string>> parts_of_line;
  for (const DrawnScenario& drawn : all) {
    parts_of_line[drawn.record.line].insert(drawn.record.split);
    EXPECT_EQ(drawn.record.split == "val", drawn.record.base == "line_1100.json");
  }
  EXPECT_EQ(parts_of_line.size(), 4U);
  for (const auto& [line, parts] : parts_of_line) EXPECT_EQ(parts.size(), 1U);
}

TEST(ScenarioDraw, PutsAMountIntoADrawnSensor) {
  const TemporaryDirectory directory;
  nlohmann::json recipe = ProjectRecipe();
  recipe["set"].erase("/lidar/range_max_m");
  recipe["draws"]["/lidar"] = {
      {"type", "choice"},
      {"values",
       {kScenariosFolder + "sensors/vlp16.json", kScenariosFolder + "sensors/hdl32e.json"}}};
  recipe["draws"]["/lidar/mount/position_m"] = {{"type", "choice"}, {"values", {{2.0, 0.0, 4.0}}}};
  std::set<std::string> sensors;
  for (const DrawnScenario& drawn : DrawAll(ReadProjectRecipe(directory.path(), recipe))) {
    sensors.insert(drawn.scenario.lidar.name);
    EXPECT_EQ(drawn.scenario.lidar.mount.position_m[2], 4.0);
  }
  EXPECT_EQ(sensors.size(), 2U);
}

}  // namespace
}  // namespace railcast
