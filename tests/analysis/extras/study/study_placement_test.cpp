#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "analysis/extras/study/study_report.h"

namespace railcast {
namespace {

// A recipe that draws a mount by name and a weather.
Json MountRecipe() {
  return Json::parse(R"({
    "groups": [
      {"name": "mount", "options": [
        {"name": "roof", "set": {"/lidar": {"mount": {"position_m": [0, 0, 3.6]}}}},
        {"name": "front", "set": {"/lidar/mount/position_m": [0, 0, 1.2]}}]},
      {"name": "weather", "options": [
        {"name": "clear", "set": {"/weather": {}}},
        {"name": "fog", "draws": {"/weather/visibility_m": {"type": "uniform"}}}]}
    ]
  })");
}

// Each target is detected at 80 m from the roof and at 60 m from the front, a metre more or less.
std::vector<ApproachRecord> MountApproaches() {
  std::vector<ApproachRecord> approaches;
  for (std::uint32_t i = 0; i < 40; ++i) {
    ApproachRecord approach{.scenario = i};
    const bool is_roof = i % 2 == 0;
    approach.drawn["mount"] = is_roof ? "roof" : "front";
    approach.drawn["weather"] = i % 4 < 2 ? "clear" : "fog";
    StudiedObject object{.name = "cube", .type = "box", .is_detected = true};
    object.distance_m = (is_roof ? 80.0 : 60.0) + (i % 8 < 4 ? 1.0 : -1.0);
    object.nearest_m = 10.0;
    object.farthest_m = 300.0;
    object.needed_m = 70.0;
    approach.objects.push_back(object);
    approaches.push_back(approach);
  }
  return approaches;
}

TEST(StudyPlacement, ListsWhatDetectsFirstAboveAllElse) {
  const auto approaches = MountApproaches();
  const auto observations = ObservationsOf(approaches);
  const Section section = PlacementSection(observations, FactorsOf(observations), MountRecipe());
  const Table& table = section.tables.at(0);
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(std::get<std::string>(table.rows[0].at(1)), "roof");
  EXPECT_EQ(std::get<std::string>(table.rows[1].at(1)), "front");
  EXPECT_DOUBLE_EQ(std::get<Estimate>(table.rows[0].at(5)).value, 80.0);
  EXPECT_DOUBLE_EQ(std::get<Estimate>(table.rows[1].at(5)).value, 60.0);
  EXPECT_EQ(std::get<Estimate>(table.rows[0].at(4)).value, 100.0);
  EXPECT_EQ(std::get<Estimate>(table.rows[1].at(4)).value, 0.0);
  ASSERT_EQ(section.charts.size(), 1U);
  EXPECT_EQ(section.charts[0].x.categories, (std::vector<std::string>{"roof", "front"}));
}

TEST(StudyPlacement, IsNoSectionWhereNothingOfTheSensorIsDrawn) {
  const auto approaches = MountApproaches();
  const auto observations = ObservationsOf(approaches);
  Json recipe = MountRecipe();
  recipe["groups"].erase(0);
  EXPECT_TRUE(PlacementSection(observations, FactorsOf(observations), recipe).tables.empty());
}

}  // namespace
}  // namespace railcast
