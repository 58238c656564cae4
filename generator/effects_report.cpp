#include "generator/effects_report.h"

#include <cmath>
#include <functional>
#include <utility>

#include "core/base/number_text.h"
#include "core/detect/beam_optics.h"
#include "core/detect/weather_optics.h"
#include "core/scenario/effect_names.h"
#include "core/scenario/scenario.h"
#include "generator/report_line.h"

namespace railcast {
namespace {

// Where r e^(extinction r) reaches the range in clear air.
double RangeInWeather_m(double clear_range_m, double extinction_per_m) {
  double near_m = 0.0;
  double far_m = clear_range_m;
  for (int i = 0; i < 60; ++i) {
    const double r = 0.5 * (near_m + far_m);
    (r * std::exp(extinction_per_m * r) < clear_range_m ? near_m : far_m) = r;
  }
  return near_m;
}

std::string FogText(const WeatherSpec& weather) {
  return "fog " + Short(FogExtinction_per_m(weather)) + " per m";
}

std::string ThresholdText(const ScenarioSpec& scenario) {
  const PlausibilitySpec& model = scenario.lidar.plausibility;
  return NumberText(model.reference_threshold) + " at " + NumberText(model.reference_range_m) +
         " m, " + FogText(scenario.weather);
}

std::string RainText(const ScenarioSpec& scenario) {
  const WeatherSpec& weather = scenario.weather;
  return NumberText(weather.rain_rate_mmph) + " mm/h, dropout " +
         NumberText(weather.rain_dropout_per_m) + " per m x rate^" +
         NumberText(weather.rain_dropout_exponent);
}

std::string SnowText(const ScenarioSpec& scenario) {
  const WeatherSpec& weather = scenario.weather;
  return NumberText(weather.snow_rate_mmph) + " mm/h, " + NumberText(weather.snow_echoes_per_mmph) +
         " flakes a beam per mm/h, range scale " + NumberText(weather.snow_range_scale_m) +
         " m, intensity " + NumberText(weather.snow_intensity);
}

std::string NoiseText(const ScenarioSpec& scenario) {
  const PlausibilitySpec& model = scenario.lidar.plausibility;
  return "sigma " + NumberText(model.noise_sigma0_m) + " m + " + Short(model.noise_sigma1) +
         " x range, " + (model.noise_shape == "beam" ? "along the beam" : "isotropic");
}

std::string SensorDropoutText(const ScenarioSpec& scenario) {
  return "probability " + NumberText(scenario.lidar.plausibility.dropout_probability);
}

std::string SurfaceConditionText(const ScenarioSpec& scenario) {
  return "wetness " + NumberText(scenario.weather.wetness) + ", snow cover " +
         NumberText(scenario.weather.snow_cover);
}

std::string ExtinctionText(const ScenarioSpec& scenario) {
  const WeatherSpec& weather = scenario.weather;
  return FogText(weather) + ", rain " + Short(RainExtinction_per_m(weather)) + ", snow " +
         Short(SnowExtinction_per_m(weather, scenario.lidar.beam.wavelength_nm)) + ", both ways";
}

std::string PulseStretchText(const ScenarioSpec& scenario) {
  return "pulse of " + NumberText(scenario.lidar.beam.pulse_length_ns) + " ns, sigma " +
         Short(PulseSigma_m(scenario.lidar.beam)) + " m";
}

std::string DetectionText(const ScenarioSpec& scenario) {
  const double clear_range_m = scenario.lidar.receiver.range_at_10_percent_m;
  const double extinction_per_m =
      EffectsOf(scenario).extinction
          ? Extinction_per_m(scenario.weather, scenario.lidar.beam.wavelength_nm)
          : 0.0;
  std::string text = "10 % at " + NumberText(clear_range_m) + " m";
  if (extinction_per_m > 0.0) {
    text +=
        ", in this weather at " + Short(RangeInWeather_m(clear_range_m, extinction_per_m)) + " m";
  }
  return text + ", return mode " + scenario.lidar.receiver.return_mode;
}

std::string DetectionProbabilityText(const ScenarioSpec& scenario) {
  return "SNR " + NumberText(scenario.lidar.receiver.snr_at_threshold) + " at the threshold";
}

std::string ClutterText(const ScenarioSpec& scenario) {
  const WeatherSpec& weather = scenario.weather;
  const ReceiverSpec& receiver = scenario.lidar.receiver;
  const double power_min = LeastPower(receiver);
  const auto text = [&](const ParticleSizes& sizes, double reflectance) {
    const ParticleEchoes echoes =
        ParticleEchoesOf(sizes, reflectance, scenario.lidar.beam, power_min);
    constexpr double kMedianOfMaxwell = 1.538;
    return Short(echoes.mean_count * receiver.clutter_gain) + " echoes a beam, half within " +
           Short(kMedianOfMaxwell * echoes.range_scale_m) + " m";
  };
  std::string all;
  if (weather.rain_rate_mmph > 0.0) {
    all = "rain " + text(RainDropSizes(weather), kDropReflectance);
  }
  if (weather.snow_rate_mmph > 0.0) {
    all += std::string(all.empty() ? "" : "; ") + "snow " +
           text(SnowFlakeSizes(weather), kFlakeReflectance);
  }
  return all.empty() ? "none" : all;
}

std::string FogEchoText(const ScenarioSpec& scenario) {
  if (FogExtinction_per_m(scenario.weather) <= 0.0) return "none";
  const FogEcho echo = FogEchoOf(scenario.weather, scenario.lidar.beam);
  return "reflectance " + Short(echo.intensity) + " at " + Short(echo.range_m) + " m";
}

std::string SunlightText(const ScenarioSpec& scenario) {
  const SunSpec& sun = scenario.weather.sun;
  return NumberText(sun.illuminance_klx) + " klx, false alarms in " +
         Short(FalseAlarmProbability(sun)) + " of the firings";
}

std::string RangeNoiseText(const ScenarioSpec& scenario) {
  const ReceiverSpec& receiver = scenario.lidar.receiver;
  const double at_threshold_m =
      std::hypot(receiver.range_noise_floor_m,
                 receiver.range_noise_scale_m / std::sqrt(2.0 * receiver.snr_at_threshold));
  return "sigma " + NumberText(receiver.range_noise_floor_m) + " m, at the threshold " +
         Short(at_threshold_m) + " m";
}

std::string ChannelBiasText(const ScenarioSpec& scenario) {
  return "sigma " + NumberText(scenario.lidar.receiver.channel_bias_sigma_m) + " m";
}

std::string PointingJitterText(const ScenarioSpec& scenario) {
  return "sigma " + NumberText(scenario.lidar.receiver.pointing_jitter_deg) + " deg";
}

std::string FootprintText(const ScenarioSpec& scenario) {
  const auto& divergence_mrad = scenario.lidar.beam.divergence_mrad;
  return "1/e^2 width " + NumberText(divergence_mrad[0]) + " x " + NumberText(divergence_mrad[1]) +
         " mrad";
}

std::string DenseFootprintText(const ScenarioSpec& scenario) {
  return NumberText(scenario.lidar.beam.reference_rays) + " sub-rays a beam";
}

// What stands behind an effect's name; those that are not here have no parameters.
const std::pair<bool EffectSet::*, std::string (*)(const ScenarioSpec&)> kTexts[] = {
    {&EffectSet::threshold, &ThresholdText},
    {&EffectSet::rain, &RainText},
    {&EffectSet::snow, &SnowText},
    {&EffectSet::noise, &NoiseText},
    {&EffectSet::sensor_dropout, &SensorDropoutText},
    {&EffectSet::surface_condition, &SurfaceConditionText},
    {&EffectSet::extinction, &ExtinctionText},
    {&EffectSet::pulse_stretch, &PulseStretchText},
    {&EffectSet::detection, &DetectionText},
    {&EffectSet::detection_probability, &DetectionProbabilityText},
    {&EffectSet::clutter, &ClutterText},
    {&EffectSet::fog_echo, &FogEchoText},
    {&EffectSet::sunlight, &SunlightText},
    {&EffectSet::range_noise, &RangeNoiseText},
    {&EffectSet::channel_bias, &ChannelBiasText},
    {&EffectSet::pointing_jitter, &PointingJitterText},
    {&EffectSet::footprint, &FootprintText},
    {&EffectSet::dense_footprint, &DenseFootprintText},
};

}  // namespace

std::string EffectsText(const ScenarioSpec& scenario) {
  const EffectSet effects = EffectsOf(scenario);
  std::string text = ReportLine("rung", scenario.fidelity);
  for (const auto& [name, effect] : kEffects) {
    if (!(effects.*effect)) continue;
    std::string line = name;
    for (const auto& [described, describe] : kTexts) {
      if (described == effect) line += ": " + describe(scenario);
    }
    text += ReportLine("", line);
  }
  return text;
}

}  // namespace railcast
