#include "analysis/fit/fitted_scenario.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace railcast {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kReferenceThreshold = 0.1;
constexpr const char* kReferenceRange = "lidar/plausibility/reference_range_m";

// Where a scenario has a parameter; null if nowhere.
double* Find(ScenarioSpec& scenario, const std::string& place) {
  PlausibilitySpec& published = scenario.lidar.plausibility;
  ReceiverSpec& receiver = scenario.lidar.receiver;
  const std::pair<const char*, double*> places[] = {
      {kReferenceRange, &published.reference_range_m},
      {"lidar/plausibility/noise_sigma0_m", &published.noise_sigma0_m},
      {"lidar/plausibility/noise_sigma1", &published.noise_sigma1},
      {"lidar/plausibility/dropout_probability", &published.dropout_probability},
      {"lidar/receiver/range_at_10_percent_m", &receiver.range_at_10_percent_m},
      {"lidar/receiver/snr_at_threshold", &receiver.snr_at_threshold},
      {"lidar/receiver/range_noise_floor_m", &receiver.range_noise_floor_m},
      {"lidar/receiver/range_noise_scale_m", &receiver.range_noise_scale_m},
      {"lidar/receiver/channel_bias_sigma_m", &receiver.channel_bias_sigma_m},
      {"lidar/receiver/pointing_jitter_deg", &receiver.pointing_jitter_deg},
      {"weather/rain_dropout_per_m", &scenario.weather.rain_dropout_per_m},
      {"weather/fog_density_per_m", &scenario.weather.fog_density_per_m}};
  for (const auto& [name, value] : places) {
    if (place == name) return value;
  }
  return nullptr;
}

// In five digits: more than any interval leaves.
double Rounded(double value) {
  if (value == 0.0) return 0.0;
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 4.0);
  // Divided where the unit is small, so that the decimal is the nearest.
  return unit < 1.0 ? std::round(value / unit) / std::round(1.0 / unit)
                    : std::round(value / unit) * unit;
}

std::string NoiseShapeOf(const RecordedTrials& trials) {
  return trials.lateral_ratio > kIsotropicRatio ? "isotropic" : "beam";
}

bool IsWritten(const FittedParameter& parameter) {
  return parameter.estimate.is_enough() && !parameter.place.empty();
}

}  // namespace

double ScenarioValue(const ScenarioSpec& scenario, const std::string& place) {
  ScenarioSpec copy = scenario;
  const double* const value = Find(copy, place);
  if (value == nullptr) return kNaN;
  if (place != kReferenceRange) return *value;
  return *value * std::sqrt(kReferenceThreshold / scenario.lidar.plausibility.reference_threshold);
}

double ScenarioReflectance(const ScenarioSpec& scenario, const std::string& material) {
  for (const Material& known : scenario.materials) {
    if (known.name != material) continue;
    return static_cast<double>(OpticsAt(known, scenario.lidar.beam.wavelength_nm).diffuse);
  }
  return kNaN;
}

std::string FittedJson(const FitSettings& settings,
                       const RecordedTrials& trials,
                       const FitResult& result) {
  using Json = nlohmann::ordered_json;
  Json json = {{"version", 1}};
  for (const FittedParameter& parameter : result.parameters) {
    if (!IsWritten(parameter)) continue;
    if (parameter.place == kReferenceRange) {
      json["lidar"]["plausibility"]["reference_threshold"] = kReferenceThreshold;
    }
    json[Json::json_pointer("/" + parameter.place)] = Rounded(parameter.estimate.value);
  }
  if (!settings.is_physical && !std::isnan(trials.lateral_ratio)) {
    json["lidar"]["plausibility"]["noise_shape"] = NoiseShapeOf(trials);
  }
  for (const SurfaceFit& surface : result.surfaces) {
    if (!surface.reflectance.is_enough()) continue;
    json["materials"].push_back(
        {{"name", surface.name}, {"reflectivity", Rounded(surface.reflectance.value)}});
  }
  return json.dump(2) + "\n";
}

ScenarioSpec FittedScenario(ScenarioSpec scenario,
                            const FitSettings& settings,
                            const RecordedTrials& trials,
                            const FitResult& result) {
  for (const FittedParameter& parameter : result.parameters) {
    if (!IsWritten(parameter)) continue;
    *Find(scenario, parameter.place) = Rounded(parameter.estimate.value);
    if (parameter.place == kReferenceRange) {
      scenario.lidar.plausibility.reference_threshold = kReferenceThreshold;
    }
    if (parameter.place == "weather/fog_density_per_m") scenario.weather.visibility_m.reset();
  }
  if (!settings.is_physical && !std::isnan(trials.lateral_ratio)) {
    scenario.lidar.plausibility.noise_shape = NoiseShapeOf(trials);
  }
  for (const SurfaceFit& surface : result.surfaces) {
    const auto material =
        std::find_if(scenario.materials.begin(), scenario.materials.end(),
                     [&](const Material& known) { return known.name == surface.name; });
    if (material == scenario.materials.end() || !surface.reflectance.is_enough()) continue;
    const double value = Rounded(surface.reflectance.value);
    if (scenario.lidar.beam.wavelength_nm == 905) {
      material->reflectivity = value;
    } else {
      material->reflectivity_1550nm = value;
    }
  }
  return scenario;
}

}  // namespace railcast
