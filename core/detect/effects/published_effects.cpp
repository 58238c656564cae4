// The table rows of the published plausibility model and of `sensor_dropout`, which the physical
// rungs share with it.
#include <cmath>
#include <limits>

#include "core/base/text.h"
#include "core/detect/base/weather_optics.h"
#include "core/detect/detector/effect_table.h"
#include "core/detect/kernels/echo_power.h"
#include "core/detect/kernels/published.h"

namespace railcast {
namespace {

using Loop = std::function<void(DetectTile&)>;

// Threshold.

bool HasThreshold(const DetectorSpec& /*spec*/) {
  return true;
}

std::string ThresholdText(const DetectorSpec& spec) {
  const PlausibilitySpec& model = spec.plausibility;
  return NumberText(model.reference_threshold) + " at " + NumberText(model.reference_range_m) +
         " m, " + FogText(spec.weather);
}

ThresholdParameters MakeThreshold(const DetectorSpec& spec) {
  const PlausibilitySpec& model = spec.plausibility;
  return {.inverse_threshold_m2 = static_cast<float>(
              model.reference_range_m * model.reference_range_m / model.reference_threshold),
          .fog_density_per_m = static_cast<float>(FogExtinction_per_m(spec.weather))};
}

Loop ThresholdLoop(const DetectorSpec& spec, const Kernels& kernels) {
  return [p = MakeThreshold(spec), apply = kernels.threshold](DetectTile& tile) { apply(tile, p); };
}

// Rain.

bool HasRain(const DetectorSpec& spec) {
  return spec.weather.rain_rate_mmph > 0.0;
}

std::string RainText(const DetectorSpec& spec) {
  const WeatherSpec& weather = spec.weather;
  return NumberText(weather.rain_rate_mmph) + " mm/h, dropout " +
         NumberText(weather.rain_dropout_per_m) + " per m x rate^" +
         NumberText(weather.rain_dropout_exponent);
}

Loop RainLoop(const DetectorSpec& spec, const Kernels& kernels) {
  const WeatherSpec& weather = spec.weather;
  const RainParameters parameters{
      .seed = spec.seed,
      .dropout_per_m =
          static_cast<float>(weather.rain_dropout_per_m *
                             std::pow(weather.rain_rate_mmph, weather.rain_dropout_exponent))};
  return [=, apply = kernels.rain](DetectTile& tile) { apply(tile, parameters); };
}

// Snow.

bool HasSnow(const DetectorSpec& spec) {
  return spec.weather.snow_rate_mmph > 0.0;
}

std::string SnowText(const DetectorSpec& spec) {
  const WeatherSpec& weather = spec.weather;
  return NumberText(weather.snow_rate_mmph) + " mm/h, " + NumberText(weather.snow_echoes_per_mmph) +
         " flakes a beam per mm/h, range scale " + NumberText(weather.snow_range_scale_m) +
         " m, intensity " + NumberText(weather.snow_intensity);
}

Loop SnowLoop(const DetectorSpec& spec, const Kernels& kernels) {
  const WeatherSpec& weather = spec.weather;
  const double mean_echoes = weather.snow_echoes_per_mmph * weather.snow_rate_mmph;
  const SnowParameters parameters{.seed = spec.seed,
                                  .probability = static_cast<float>(-std::expm1(-mean_echoes)),
                                  .range_scale_m = static_cast<float>(weather.snow_range_scale_m),
                                  .range_min_m = static_cast<float>(spec.range_min_m),
                                  .intensity = spec.effects.threshold
                                                   ? static_cast<float>(weather.snow_intensity)
                                                   : std::numeric_limits<float>::quiet_NaN(),
                                  .has_threshold = spec.effects.threshold,
                                  .label = spec.clutter_labels.snow,
                                  .threshold = MakeThreshold(spec)};
  return [=, apply = kernels.snow](DetectTile& tile) { apply(tile, parameters); };
}

// Noise. It acts in the measurement, which every rung has.

bool HasNoise(const DetectorSpec& spec) {
  return spec.plausibility.noise_sigma0_m > 0.0 || spec.plausibility.noise_sigma1 > 0.0;
}

std::string NoiseText(const DetectorSpec& spec) {
  const PlausibilitySpec& model = spec.plausibility;
  return "sigma " + NumberText(model.noise_sigma0_m) + " m + " + ShortText(model.noise_sigma1) +
         " x range, " + (model.noise_shape == NoiseShape::kBeam ? "along the beam" : "isotropic");
}

// Sensor dropout.

bool HasSensorDropout(const DetectorSpec& spec) {
  const PlausibilitySpec& model = spec.plausibility;
  return model.dropout_probability > 0.0 || model.dropout_per_m > 0.0 ||
         model.dark_dropout_probability > 0.0;
}

std::string SensorDropoutText(const DetectorSpec& spec) {
  std::string text = "probability " + NumberText(spec.plausibility.dropout_probability);
  if (spec.plausibility.dropout_per_m > 0.0) {
    text += ", growing by " + ShortText(spec.plausibility.dropout_per_m) + " per m";
  }
  if (spec.plausibility.dark_dropout_probability > 0.0) {
    text += ", on dark surfaces up to " + NumberText(spec.plausibility.dark_dropout_probability);
  }
  return text;
}

Loop SensorDropoutLoop(const DetectorSpec& spec, const Kernels& kernels) {
  const SensorDropoutParameters parameters{
      .seed = spec.seed,
      .probability = static_cast<float>(spec.plausibility.dropout_probability),
      .per_m = static_cast<float>(spec.plausibility.dropout_per_m),
      .dark_probability = static_cast<float>(spec.plausibility.dark_dropout_probability),
      .inverse_dark_intensity = static_cast<float>(1.0 / spec.plausibility.dark_dropout_intensity)};
  return [=, apply = kernels.sensor_dropout](DetectTile& tile) { apply(tile, parameters); };
}

}  // namespace

std::vector<Effect> PublishedEffects() {
  const std::vector<Fidelity> plausibility{Fidelity::kPlausibility};
  const std::vector<Fidelity> all_but_geometry{Fidelity::kPlausibility, Fidelity::kSurface,
                                               Fidelity::kFootprint, Fidelity::kReference};
  return {
      {.name = "threshold",
       .is_on = &EffectSet::threshold,
       .rungs = plausibility,
       .has_cause = HasThreshold,
       .text = &ThresholdText,
       .weather_keys = {"fog_density_per_m", "visibility_m"},
       .loops = {{StepOrder::kThreshold, &ThresholdLoop}}},
      {.name = "rain",
       .is_on = &EffectSet::rain,
       .rungs = plausibility,
       .has_cause = HasRain,
       .text = &RainText,
       .weather_keys = {"rain_rate_mmph", "rain_dropout_per_m", "rain_dropout_exponent"},
       .loops = {{StepOrder::kRain, &RainLoop}}},
      {.name = "snow",
       .is_on = &EffectSet::snow,
       .rungs = plausibility,
       .has_cause = HasSnow,
       .text = &SnowText,
       .weather_keys = {"snow_rate_mmph", "snow_echoes_per_mmph", "snow_range_scale_m",
                        "snow_intensity"},
       .labels = {{"snow", &ClutterLabels::snow}},
       .loops = {{StepOrder::kSnow, &SnowLoop}}},
      {.name = "noise",
       .is_on = &EffectSet::noise,
       .rungs = plausibility,
       .has_cause = HasNoise,
       .text = &NoiseText,
       .is_measurement_error = true},
      {.name = "sensor_dropout",
       .is_on = &EffectSet::sensor_dropout,
       .rungs = all_but_geometry,
       .has_cause = HasSensorDropout,
       .text = &SensorDropoutText,
       .loops = {{StepOrder::kSensorDropout, &SensorDropoutLoop}}},
  };
}

}  // namespace railcast
