#include <algorithm>
#include <string_view>

#include "core/base/text.h"
#include "core/detect/detector/effect_table.h"
#include "core/scenario/descriptions.h"
#include "core/scenario/json_writer.h"
#include "generator/check/check_report.h"
#include "railcast/effects.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

bool IsReadByAny(std::string_view key, const EffectSet& effects) {
  return std::ranges::any_of(EffectTable(), [&](const Effect& effect) {
    return effects.*effect.is_on &&
           std::ranges::find(effect.weather_keys, key) != effect.weather_keys.end();
  });
}

/// Lists the keys that the scenario gives although neither an active effect nor a camera reads
/// them. The wind moves the world itself.
std::string IdleWeatherText(const ScenarioSpec& scenario, const EffectSet& effects) {
  // What Extinction_per_m() and Daylight read.
  constexpr std::string_view kOfCamera[] = {"fog_density_per_m", "visibility_m",   "rain_rate_mmph",
                                            "rain_drop_sizes",   "snow_rate_mmph", "snow_type",
                                            "wetness",           "snow_cover",     "sun"};
  std::string names;
  WeatherSpec weather = scenario.weather;
  const Json given = JsonWriter::WriteShort(weather);
  for (const auto& [key, value] : given.items()) {
    if (key.starts_with("wind_") || IsReadByAny(key, effects)) continue;
    if (scenario.camera && std::ranges::find(kOfCamera, key) != std::end(kOfCamera)) continue;
    names += (names.empty() ? "" : ", ") + key;
  }
  if (names.empty()) return "";
  return ReportLine("", "no effect that is on reads these keys of weather: " + names);
}

std::string WindText(const WeatherSpec& weather) {
  if (weather.wind_speed_mps == 0.0) return "";
  return ReportLine("wind", NumberText(weather.wind_speed_mps) + " m/s from " +
                                NumberText(weather.wind_direction_deg) +
                                " deg: trees and wires sway, fog drifts");
}

}  // namespace

std::string EffectsText(const ScenarioSpec& scenario) {
  const EffectSet effects = EffectsOf(scenario);
  const DetectorSpec spec = DetectorSpecOf(scenario, scenario.lidar, effects);
  std::string text = ReportLine("rung", std::string(NameOf(scenario.fidelity)));
  for (const Effect& effect : EffectTable()) {
    if (!(effects.*effect.is_on)) continue;
    const std::string name = effect.name;
    text += ReportLine("", effect.text == nullptr ? name : name + ": " + effect.text(spec));
  }
  return text + IdleWeatherText(scenario, effects) + WindText(scenario.weather);
}

}  // namespace railcast
