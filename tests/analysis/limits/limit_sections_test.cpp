#include "analysis/limits/limit_sections.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace railcast {
namespace {

using PlainJson = nlohmann::json;

ScenarioSpec OnRung(const std::string& fidelity) {
  const PlainJson json = {{"version", 1},
                          {"file", RAILCAST_SOURCE_DIR "/scenarios/minimal.json"},
                          {"fidelity", fidelity}};
  return ReadScenarioText(json.dump(), "scenario.json");
}

// A scenario with a shipped sensor.
// @param name Of the sensor, as several sensors of one train have; empty for the preset's own.
ScenarioSpec WithPreset(const std::string& preset, const std::string& name) {
  PlainJson lidar = {{"file", RAILCAST_SOURCE_DIR "/scenarios/sensors/" + preset},
                     {"mount", {{"position_m", {1.0, 0.0, 3.0}}}}};
  if (!name.empty()) lidar["name"] = name;
  const PlainJson json = {
      {"version", 1}, {"file", RAILCAST_SOURCE_DIR "/scenarios/minimal.json"}, {"lidar", lidar}};
  return ReadScenarioText(json.dump(), "scenario.json");
}

const std::string& TextIn(const Cell& cell) {
  return std::get<std::string>(cell);
}

std::vector<std::vector<Cell>> SensorRows(const std::vector<ScenarioSpec>& sample) {
  return SensorSection(sample).tables.at(0).rows;
}

// The texts of the first column.
std::vector<std::string> LimitsOf(const std::vector<ScenarioSpec>& sample, bool has_detector) {
  const Section section = LimitsSection(sample, has_detector);
  std::vector<std::string> texts;
  for (const auto& row : section.tables.at(0).rows) texts.push_back(TextIn(row.at(0)));
  return texts;
}

bool Has(const std::vector<std::string>& texts, const std::string& text) {
  return std::ranges::find(texts, text) != texts.end();
}

TEST(SensorSection, CallsASensorWithoutRecordingNotValidated) {
  const auto rows = SensorRows({OnRung("surface")});
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(TextIn(rows[0].at(1)), "not validated: not compared with recordings");
  EXPECT_TRUE(std::isnan(std::get<double>(rows[0].at(2))));
}

TEST(SensorSection, TakesAPresetForValidatedOnlyAsItWasCompared) {
  ScenarioSpec scenario = WithPreset("vls128.json", "");
  const auto rows = SensorRows({scenario});
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(TextIn(rows[0].at(0)), "VLS-128");
  EXPECT_EQ(TextIn(rows[0].at(1)), "preset compared with a recording");
  EXPECT_EQ(std::get<double>(rows[0].at(2)), 0.008);
  scenario.lidar.receiver.range_noise_floor_m += 0.001;
  const auto changed = SensorRows({scenario});
  ASSERT_EQ(changed.size(), 1U);
  EXPECT_EQ(TextIn(changed[0].at(1)), "not validated: changed from the preset");
  EXPECT_TRUE(std::isnan(std::get<double>(changed[0].at(2))));
}

TEST(SensorSection, NamesThePresetOfEachOfSeveralSensors) {
  const ScenarioSpec left = WithPreset("vls128.json", "left");
  const auto rows = SensorRows({left, WithPreset("vls128.json", "right"), left});
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(TextIn(rows[0].at(0)), "left (VLS-128)");
  EXPECT_EQ(TextIn(rows[1].at(0)), "right (VLS-128)");
  for (const auto& row : rows) {
    EXPECT_EQ(TextIn(row.at(1)), "preset compared with a recording");
    EXPECT_EQ(std::get<double>(row.at(2)), 0.008);
  }
}

TEST(LimitsSection, ListsTheLimitsOfItsRungAlone) {
  const std::vector<std::string> limits = LimitsOf({OnRung("surface")}, false);
  EXPECT_TRUE(Has(limits, "A beam has a width"));
  EXPECT_TRUE(Has(limits, "Glass lets light through"));
  EXPECT_FALSE(Has(limits, "Rain and snow weaken echoes"));
}

// A detector tells obstacles from clutter itself, whereas a count of points takes that for granted.
TEST(LimitsSection, LeavesToADetectorWhatOnlyCountsOfPointsLack) {
  const std::string points = "A detector must tell obstacles from track and clutter";
  EXPECT_TRUE(Has(LimitsOf({OnRung("surface")}, false), points));
  EXPECT_FALSE(Has(LimitsOf({OnRung("surface")}, true), points));
}

// What `auto` leaves out of the footprint, the scene does not need.
TEST(LimitsSection, HasForAutoTheLimitsOfTheFootprint) {
  const std::vector<std::string> limits = LimitsOf({OnRung("auto")}, false);
  EXPECT_EQ(limits, LimitsOf({OnRung("footprint")}, false));
  EXPECT_FALSE(Has(limits, "A beam has a width"));
}

TEST(LimitsSection, HasTheLimitsOfAllRungsOfASampleOnce) {
  const std::vector<std::string> both =
      LimitsOf({OnRung("surface"), OnRung("footprint"), OnRung("surface")}, false);
  for (const char* const rung : {"surface", "footprint"}) {
    for (const std::string& limit : LimitsOf({OnRung(rung)}, false)) {
      EXPECT_EQ(std::ranges::count(both, limit), 1) << limit;
    }
  }
}

}  // namespace
}  // namespace railcast
