#include "analysis/fit/fitted_scenario.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

namespace railcast {
namespace {

// The residuals are measured along the beam.
constexpr NoiseShape kNoiseShape = NoiseShape::kBeam;

// Finds a parameter in a scenario; null if the scenario has no such place.
double* Find(ScenarioSpec& scenario, const std::string& place) {
  PlausibilitySpec& published = scenario.lidar.plausibility;
  ReceiverSpec& receiver = scenario.lidar.receiver;
  const std::pair<const char*, double*> places[] = {
      {"lidar/plausibility/noise_sigma0_m", &published.noise_sigma0_m},
      {"lidar/plausibility/noise_sigma1", &published.noise_sigma1},
      {"lidar/plausibility/dropout_probability", &published.dropout_probability},
      {"lidar/receiver/range_noise_floor_m", &receiver.range_noise_floor_m},
      {"lidar/receiver/range_noise_scale_m", &receiver.range_noise_scale_m},
      {"lidar/receiver/pointing_jitter_deg", &receiver.pointing_jitter_deg},
      {"weather/rain_dropout_per_m", &scenario.weather.rain_dropout_per_m}};
  for (const auto& [name, value] : places) {
    if (place == name) return value;
  }
  return nullptr;
}

// Rounds to five digits, which is finer than any interval.
double RoundedParameter(double value) {
  if (value == 0.0) return 0.0;
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 4.0);
  // Divide where the unit is small, so that the result is the nearest decimal.
  return unit < 1.0 ? std::round(value / unit) / std::round(1.0 / unit)
                    : std::round(value / unit) * unit;
}

bool IsWritten(const FittedParameter& parameter) {
  return parameter.estimate.is_enough() && !parameter.place.empty();
}

bool HasPublishedNoise(const FitResult& result) {
  return std::any_of(result.parameters.begin(), result.parameters.end(),
                     [](const FittedParameter& parameter) {
                       return parameter.place == "lidar/plausibility/noise_sigma0_m" &&
                              parameter.estimate.is_enough();
                     });
}

}  // namespace

double ScenarioValue(const ScenarioSpec& scenario, const std::string& place) {
  ScenarioSpec copy = scenario;
  const double* const value = Find(copy, place);
  return value == nullptr ? std::numeric_limits<double>::quiet_NaN() : *value;
}

std::string FittedJson(const FitResult& result) {
  using Json = nlohmann::ordered_json;
  Json json = {{"version", 1}};
  for (const FittedParameter& parameter : result.parameters) {
    if (!IsWritten(parameter)) continue;
    json[Json::json_pointer("/" + parameter.place)] = RoundedParameter(parameter.estimate.value);
  }
  if (HasPublishedNoise(result)) json["lidar"]["plausibility"]["noise_shape"] = NameOf(kNoiseShape);
  return json.dump(2) + "\n";
}

ScenarioSpec FittedScenario(ScenarioSpec scenario, const FitResult& result) {
  for (const FittedParameter& parameter : result.parameters) {
    if (!IsWritten(parameter)) continue;
    *Find(scenario, parameter.place) = RoundedParameter(parameter.estimate.value);
  }
  if (HasPublishedNoise(result)) scenario.lidar.plausibility.noise_shape = kNoiseShape;
  return scenario;
}

}  // namespace railcast
