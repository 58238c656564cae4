#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "analysis/limits/limit_sections.h"
#include "analysis/report/words.h"
#include "core/io/sensor_tables.h"
#include "core/scenario/json_text.h"

namespace railcast {

extern const char* const kLimits;
extern const char* const kLimitsWords;
extern const char* const kValidatedSensors;

namespace {

using ComparedSensors = std::map<std::string, Json>;

// A shipped sensor, on the mount and under the name of the scenario's own.
std::optional<LidarSpec> ShippedSensor(const std::string& name, const ScenarioSpec& scenario) {
  const auto text = SensorFileOf(name);
  if (!text) return std::nullopt;
  Json resolved = Json::parse(ResolvedScenarioJson(scenario));
  Json lidar = Json::parse(*text);
  lidar.erase("version");
  lidar.erase("$schema");
  lidar["mount"] = resolved.at("lidar").at("mount");
  lidar["name"] = scenario.lidar.name;
  resolved["lidar"] = std::move(lidar);
  return ReadScenarioText(resolved.dump(), "sensor.json").lidar;
}

// The preset that a scenario's sensor is; of several sensors each has a name of its own.
ComparedSensors::const_iterator PresetOf(const ScenarioSpec& scenario,
                                         const ComparedSensors& compared) {
  return std::ranges::find_if(compared, [&](const auto& preset) {
    const auto shipped = ShippedSensor(preset.first, scenario);
    return shipped && *shipped == scenario.lidar;
  });
}

double NumberOrAbsent(const Json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

}  // namespace

Section SensorSection(const std::vector<ScenarioSpec>& sample) {
  ComparedSensors compared;
  for (const Json& row : Json::parse(kValidatedSensors)) {
    compared.emplace(row.at("sensor").get<std::string>(), row);
  }
  Table table = TableOf(kLimitsWords, "sensor");
  std::set<std::pair<std::string, std::string>> seen;
  std::vector<LidarSpec> looked_at;  // A preset is read from its file for each comparison.
  for (const ScenarioSpec& scenario : sample) {
    if (std::ranges::find(looked_at, scenario.lidar) != looked_at.end()) continue;
    looked_at.push_back(scenario.lidar);
    std::string name = scenario.lidar.name.empty() ? "without a name" : scenario.lidar.name;
    const auto row = PresetOf(scenario, compared);
    const bool is_shown = row != compared.end();
    std::string state = "preset compared with a recording";
    if (!is_shown) {
      state =
          std::string("not validated: ") +
          (compared.contains(name) ? "changed from the preset" : "not compared with recordings");
    } else if (row->first != name) {
      name += " (" + row->first + ")";
    }
    if (!seen.emplace(name, state).second) continue;
    const auto figure = [&](const char* key) -> Cell {
      return is_shown ? NumberOrAbsent(row->second.at(key))
                      : std::numeric_limits<double>::quiet_NaN();
    };
    table.rows.push_back({name, state, figure("points_error"), figure("intensity_error"),
                          figure("noise_ratio"), figure("holes_recorded"),
                          figure("holes_simulated")});
  }
  Section section = SectionOf(kLimitsWords, "sensor");
  section.tables = {std::move(table)};
  return section;
}

Section LimitsSection(const std::vector<ScenarioSpec>& sample, bool has_detector) {
  std::set<std::string> rungs;
  for (const ScenarioSpec& scenario : sample) {
    // What `auto` leaves out of its rung, the scene does not need.
    const bool is_auto = scenario.fidelity == Fidelity::kAuto;
    rungs.emplace(NameOf(is_auto ? Fidelity::kFootprint : scenario.fidelity));
  }
  Table table = TableOf(kLimitsWords, "limits");
  for (const Json& row : Json::parse(kLimits)) {
    const bool is_due = std::ranges::any_of(
        row.at("rungs"), [&](const Json& rung) { return rungs.contains(rung.get<std::string>()); });
    if (!is_due || (has_detector && row.value("without_detector", false))) continue;
    table.rows.push_back({row.at("real").get<std::string>(), row.at("model").get<std::string>(),
                          row.at("errs").get<std::string>()});
  }
  Section section = SectionOf(kLimitsWords, "limits");
  section.tables = {std::move(table)};
  return section;
}

}  // namespace railcast
