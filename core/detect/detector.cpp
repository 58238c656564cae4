#include "core/detect/detector.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace railcast {
namespace {

ThresholdParameters MakeThreshold(const DetectorSpec& spec) {
  const PlausibilitySpec& model = spec.plausibility;
  return {.inverse_threshold_m2 = static_cast<float>(
              model.reference_range_m * model.reference_range_m / model.reference_threshold),
          .fog_density_per_m = static_cast<float>(spec.weather.fog_density_per_m)};
}

RainParameters MakeRain(const DetectorSpec& spec) {
  const WeatherSpec& weather = spec.weather;
  return {.seed = spec.seed,
          .dropout_per_m =
              static_cast<float>(weather.rain_dropout_per_m *
                                 std::pow(weather.rain_rate_mmph, weather.rain_dropout_exponent))};
}

SnowParameters MakeSnow(const DetectorSpec& spec) {
  const WeatherSpec& weather = spec.weather;
  const double mean_echoes = weather.snow_echoes_per_mmph * weather.snow_rate_mmph;
  return {.seed = spec.seed,
          .probability = static_cast<float>(-std::expm1(-mean_echoes)),
          .range_scale_m = static_cast<float>(weather.snow_range_scale_m),
          .range_min_m = static_cast<float>(spec.range_min_m),
          .intensity = spec.effects.threshold ? static_cast<float>(weather.snow_intensity)
                                              : std::numeric_limits<float>::quiet_NaN(),
          .has_threshold = spec.effects.threshold,
          .threshold = MakeThreshold(spec)};
}

Detector::Step MakeMeasurement(const DetectorSpec& spec, const Kernels& kernels) {
  const MeasurementParameters parameters{
      .seed = spec.seed,
      .sigma0_m = static_cast<float>(spec.plausibility.noise_sigma0_m),
      .sigma1 = static_cast<float>(spec.plausibility.noise_sigma1),
      .range_min_m = static_cast<float>(spec.range_min_m),
      .range_max_m = static_cast<float>(spec.range_max_m)};
  auto* measure = kernels.measure_exact;
  if (spec.effects.noise) {
    measure = spec.plausibility.noise_shape == "beam" ? kernels.measure_along_beam
                                                      : kernels.measure_isotropic;
  }
  return {spec.effects.noise ? "noise" : "measurement",
          [=](DetectTile& tile) { measure(tile, parameters); }};
}

// Without the threshold no power is computed: the fields say so.
void LeavePowerOut(DetectTile& tile) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  std::fill_n(tile.intensity, tile.num_rays, kNaN);
  std::fill_n(tile.power_ratio, tile.num_rays, kNaN);
}

}  // namespace

Detector::Detector(const DetectorSpec& spec, const Kernels& kernels) {
  const auto range_min_m = static_cast<float>(spec.range_min_m);
  steps_.push_back({"hit", [=, hit = kernels.hit](DetectTile& tile) { hit(tile, range_min_m); }});
  // First: a pulse that was never sent meets neither surface nor snow.
  if (spec.effects.sensor_dropout && spec.plausibility.dropout_probability > 0.0) {
    const SensorDropoutParameters parameters{
        .seed = spec.seed,
        .probability = static_cast<float>(spec.plausibility.dropout_probability)};
    steps_.push_back({"sensor_dropout", [=, apply = kernels.sensor_dropout](DetectTile& tile) {
                        apply(tile, parameters);
                      }});
  }
  if (spec.effects.threshold) {
    steps_.push_back({"threshold", [p = MakeThreshold(spec), apply = kernels.threshold](
                                       DetectTile& tile) { apply(tile, p); }});
  } else {
    steps_.push_back({"no threshold", &LeavePowerOut});
  }
  // An effect whose cause is absent is left out: no rain, no snow, no dropout, no work.
  if (spec.effects.rain && spec.weather.rain_rate_mmph > 0.0) {
    steps_.push_back(
        {"rain", [p = MakeRain(spec), apply = kernels.rain](DetectTile& tile) { apply(tile, p); }});
  }
  if (spec.effects.snow && spec.weather.snow_rate_mmph > 0.0) {
    steps_.push_back(
        {"snow", [p = MakeSnow(spec), apply = kernels.snow](DetectTile& tile) { apply(tile, p); }});
  }
  steps_.push_back(MakeMeasurement(spec, kernels));
}

void Detector::Run(DetectTile& tile) const {
  for (const Step& step : steps_) step.apply(tile);
}

}  // namespace railcast
