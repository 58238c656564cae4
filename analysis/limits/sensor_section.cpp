#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "analysis/limits/limit_sections.h"
#include "core/io/sensor_tables.h"
#include "core/scenario/json_text.h"

namespace railcast {

extern const char* const kValidatedSensors;

namespace {

// The scenario's sensor with everything that its shipped file says, on the scenario's mount.
std::optional<LidarSpec> ShippedSensor(const ScenarioSpec& scenario) {
  const auto text = SensorFileOf(scenario.lidar.name);
  if (!text) return std::nullopt;
  Json resolved = Json::parse(ResolvedScenarioJson(scenario));
  Json lidar = Json::parse(*text);
  lidar.erase("version");
  lidar.erase("$schema");
  lidar["mount"] = resolved.at("lidar").at("mount");
  resolved["lidar"] = std::move(lidar);
  return ReadScenarioText(resolved.dump(), "sensor.json").lidar;
}

std::string StateOf(const ScenarioSpec& scenario, bool is_compared) {
  const auto shipped = ShippedSensor(scenario);
  if (!shipped || !is_compared) return "not validated: not compared with recordings";
  if (*shipped != scenario.lidar) return "not validated: changed from the preset";
  return "preset compared with a recording";
}

double NumberOrAbsent(const Json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

}  // namespace

Section SensorSection(const std::vector<ScenarioSpec>& sample) {
  std::map<std::string, Json> compared;
  for (const Json& row : Json::parse(kValidatedSensors)) {
    compared.emplace(row.at("sensor").get<std::string>(), row);
  }
  Table table;
  table.key = "sensor";
  table.title = "The sensor's preset against recordings";
  table.note =
      "On planes of one recording of each sensor, on halves of the scene that no parameter was "
      "fitted to (docs/validation.md): error of the number of points over bins of range, error of "
      "the intensities over cells, simulated over recorded noise, and the share of firings on "
      "planes without a point. Nothing of these recordings is of railways, and none is in rain or "
      "fog.";
  table.is_open = true;
  table.columns = {{"sensor", "Sensor", ""},
                   {"state", "State", ""},
                   {"points_error", "Error of points", ""},
                   {"intensity_error", "Error of intensity", ""},
                   {"noise_ratio", "Noise ratio", ""},
                   {"holes_recorded", "Holes, recorded", ""},
                   {"holes_simulated", "Holes, simulated", ""}};
  std::set<std::pair<std::string, std::string>> seen;
  for (const ScenarioSpec& scenario : sample) {
    const std::string name = scenario.lidar.name.empty() ? "without a name" : scenario.lidar.name;
    const auto row = compared.find(name);
    const std::string state = StateOf(scenario, row != compared.end());
    if (!seen.emplace(name, state).second) continue;
    const bool is_shown = state.starts_with("preset");
    const auto figure = [&](const char* key) -> Cell {
      return is_shown ? NumberOrAbsent(row->second.at(key))
                      : std::numeric_limits<double>::quiet_NaN();
    };
    table.rows.push_back({name, state, figure("points_error"), figure("intensity_error"),
                          figure("noise_ratio"), figure("holes_recorded"),
                          figure("holes_simulated")});
  }
  return {.key = "sensor", .title = "The sensor", .tables = {std::move(table)}};
}

}  // namespace railcast
