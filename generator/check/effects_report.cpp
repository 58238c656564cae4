#include <algorithm>
#include <string_view>

#include "core/base/text.h"
#include "core/detect/detector/effect_table.h"
#include "generator/check/check_report.h"
#include "railcast/effects.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

/// A key of section `weather` that effects read. The wind moves the world itself.
struct WeatherKey {
  std::string_view name;
  bool (*is_given)(const WeatherSpec&);  ///< Whether its value differs from the default.
};

template <auto kMember>
bool IsGiven(const WeatherSpec& weather) {
  return weather.*kMember != WeatherSpec().*kMember;
}

using W = WeatherSpec;
constexpr WeatherKey kWeatherKeys[] = {
    {"fog_density_per_m", &IsGiven<&W::fog_density_per_m>},
    {"visibility_m", &IsGiven<&W::visibility_m>},
    {"fog_variation", &IsGiven<&W::fog_variation>},
    {"rain_rate_mmph", &IsGiven<&W::rain_rate_mmph>},
    {"rain_drop_sizes", &IsGiven<&W::rain_drop_sizes>},
    {"rain_dropout_per_m", &IsGiven<&W::rain_dropout_per_m>},
    {"rain_dropout_exponent", &IsGiven<&W::rain_dropout_exponent>},
    {"snow_rate_mmph", &IsGiven<&W::snow_rate_mmph>},
    {"snow_type", &IsGiven<&W::snow_type>},
    {"snow_echoes_per_mmph", &IsGiven<&W::snow_echoes_per_mmph>},
    {"snow_range_scale_m", &IsGiven<&W::snow_range_scale_m>},
    {"snow_intensity", &IsGiven<&W::snow_intensity>},
    {"wetness", &IsGiven<&W::wetness>},
    {"snow_cover", &IsGiven<&W::snow_cover>},
    {"puddle_share", &IsGiven<&W::puddle_share>},
    {"spray_extinction_per_m", &IsGiven<&W::spray_extinction_per_m>},
    {"sun", &IsGiven<&W::sun>},
};

bool IsReadByAny(std::string_view key, const EffectSet& effects) {
  return std::ranges::any_of(EffectTable(), [&](const Effect& effect) {
    return effects.*effect.is_on &&
           std::ranges::find(effect.weather_keys, key) != effect.weather_keys.end();
  });
}

/// Lists the keys that the scenario gives although neither an active effect nor a camera reads
/// them.
std::string IdleWeatherText(const ScenarioSpec& scenario, const EffectSet& effects) {
  // What Extinction_per_m() and Daylight read.
  constexpr std::string_view kOfCamera[] = {"fog_density_per_m", "visibility_m",   "rain_rate_mmph",
                                            "rain_drop_sizes",   "snow_rate_mmph", "snow_type",
                                            "wetness",           "snow_cover",     "sun"};
  std::string names;
  for (const WeatherKey& key : kWeatherKeys) {
    if (!key.is_given(scenario.weather) || IsReadByAny(key.name, effects)) continue;
    if (scenario.camera && std::ranges::find(kOfCamera, key.name) != std::end(kOfCamera)) continue;
    names += (names.empty() ? "" : ", ") + std::string(key.name);
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
