// The table rows of the physical effects of surfaces, air and receiver.
#include <algorithm>
#include <cmath>

#include "core/base/text.h"
#include "core/base/units.h"
#include "core/detect/base/beam_optics.h"
#include "core/detect/base/weather_optics.h"
#include "core/detect/beam/footprint.h"
#include "core/detect/beam/mirror_paths.h"
#include "core/detect/clutter/fog_profile.h"
#include "core/detect/detector/effect_table.h"
#include "core/detect/effects/spray.h"
#include "core/detect/kernels/echo_power.h"
#include "core/detect/kernels/surface_response.h"

namespace railcast {
namespace {

using Loop = std::function<void(DetectTile&)>;

// For effects of surfaces, pulse and receiver, which every simulation has.
bool Always(const DetectorSpec& /*spec*/) {
  return true;
}

// Surface condition.

bool HasSurfaceCondition(const DetectorSpec& spec) {
  return WetnessOf(spec.weather) > 0.0 || spec.weather.snow_cover > 0.0;
}

std::string SurfaceConditionText(const DetectorSpec& spec) {
  return "wetness " + NumberText(WetnessOf(spec.weather)) + ", snow cover " +
         NumberText(spec.weather.snow_cover);
}

// Texture acts where beams are traced.

bool HasTexture(const DetectorSpec& spec) {
  return spec.has_texture;
}

std::string TextureText(const DetectorSpec& spec) {
  return spec.has_texture ? "cells of 3 cm" : "none: no material has one";
}

// Extinction.

double ExtinctionOf_per_m(const DetectorSpec& spec) {
  return Extinction_per_m(spec.weather, spec.beam.wavelength_nm);
}

bool HasExtinction(const DetectorSpec& spec) {
  return ExtinctionOf_per_m(spec) > 0.0;
}

std::string ExtinctionText(const DetectorSpec& spec) {
  const WeatherSpec& weather = spec.weather;
  return FogText(weather) + ", rain " + ShortText(RainExtinction_per_m(weather)) + ", snow " +
         ShortText(SnowExtinction_per_m(weather, spec.beam.wavelength_nm)) + ", both ways";
}

Loop ExtinctionLoop(const DetectorSpec& spec, const Kernels& kernels) {
  return [alpha = static_cast<float>(ExtinctionOf_per_m(spec)),
          apply = kernels.extinction](DetectTile& tile) { apply(tile, alpha); };
}

// Pulse stretch.

std::string PulseStretchText(const DetectorSpec& spec) {
  return "pulse of " + NumberText(spec.beam.pulse_length_ns) + " ns, sigma " +
         ShortText(PulseSigma_m(spec.beam)) + " m" +
         (StretchLowersPower(spec) ? "" : "; the energy is detected, which it leaves as it is");
}

Loop PulseStretchLoop(const DetectorSpec& spec, const Kernels& kernels) {
  const PulseStretchParameters parameters{
      .pulse_sigma_m = static_cast<float>(PulseSigma_m(spec.beam)),
      .lowers_power = StretchLowersPower(spec),
      .moves_peak = HasFootprint(spec)};
  return [=, apply = kernels.pulse_stretch](DetectTile& tile) { apply(tile, parameters); };
}

// Mirror paths act where beams are traced.

std::string MirrorPathsText(const DetectorSpec& spec) {
  const double share = spec.weather.puddle_share;
  std::string text =
      share > 0.0 ? "puddles on " + ShortText(100.0 * share) + " % of the level ground" : "";
  if (spec.has_mirrors) text += (text.empty() ? "" : ", ") + std::string("smooth surfaces");
  return text.empty() ? "none: no puddles and nothing smooth" : text;
}

// Detection.

// Detection range r in this weather: r e^(extinction r) = range in clear air, by bisection.
double RangeInWeather_m(double clear_range_m, double extinction_per_m) {
  double near_m = 0.0;
  double far_m = clear_range_m;
  for (int i = 0; i < 60; ++i) {
    const double r = 0.5 * (near_m + far_m);
    (r * std::exp(extinction_per_m * r) < clear_range_m ? near_m : far_m) = r;
  }
  return near_m;
}

std::string DetectionText(const DetectorSpec& spec) {
  const double clear_range_m = spec.receiver.range_at_10_percent_m;
  const double extinction_per_m = spec.effects.extinction ? ExtinctionOf_per_m(spec) : 0.0;
  std::string text = "10 % at " + NumberText(clear_range_m) + " m";
  if (extinction_per_m > 0.0) {
    text += ", in this weather at " + ShortText(RangeInWeather_m(clear_range_m, extinction_per_m)) +
            " m";
  }
  return text + ", return mode " + std::string(NameOf(spec.receiver.return_mode));
}

std::string DetectionProbabilityText(const DetectorSpec& spec) {
  return "SNR " + NumberText(spec.receiver.snr_at_threshold) + " at the threshold";
}

// One loop for both effects: `detection_probability` makes the threshold gradual.
Loop DetectionLoop(const DetectorSpec& spec, const Kernels& kernels) {
  const DetectionParameters parameters{
      .seed = spec.seed, .snr_at_threshold = static_cast<float>(spec.receiver.snr_at_threshold)};
  auto* const apply =
      spec.effects.detection_probability ? kernels.smooth_detection : kernels.detection;
  return [=](DetectTile& tile) { apply(tile, parameters); };
}

// Clutter.

bool HasClutter(const DetectorSpec& spec) {
  return spec.receiver.clutter_gain > 0.0 &&
         (spec.weather.rain_rate_mmph > 0.0 || spec.weather.snow_rate_mmph > 0.0);
}

std::string ClutterText(const DetectorSpec& spec) {
  const WeatherSpec& weather = spec.weather;
  const double power_min = LeastPower(spec.receiver);
  const auto text = [&](const ParticleSizes& sizes, double reflectance) {
    const ParticleEchoes echoes = ParticleEchoesOf(sizes, reflectance, spec.beam, power_min);
    constexpr double kMedianOfMaxwell = 1.538;
    return ShortText(echoes.mean_count * spec.receiver.clutter_gain) +
           " echoes a beam, half within " + ShortText(kMedianOfMaxwell * echoes.range_scale_m) +
           " m";
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

// Fog echo.

bool HasFogEcho(const DetectorSpec& spec) {
  return spec.weather.visibility_m.has_value() || spec.weather.fog_density_per_m > 0.0;
}

std::string FogEchoText(const DetectorSpec& spec) {
  if (FogExtinction_per_m(spec.weather) <= 0.0) return "none";
  const FogProfile profile = FogProfileOf(spec);
  if (profile.ratio.empty()) return "none: too weak to be detected";
  const auto peak = std::max_element(profile.ratio.begin(), profile.ratio.end());
  const auto gate = static_cast<std::size_t>(peak - profile.ratio.begin());
  return "at most " + ShortText(static_cast<double>(*peak)) + " of the threshold at " +
         ShortText(GateRange_m(profile, gate)) + " m, patches of sigma " +
         NumberText(spec.weather.fog_variation);
}

// Spray: acts between tracing and detection, where the trains are known.

std::string SprayText(const DetectorSpec& spec) {
  if (!HasSpray(spec)) return "none";
  return "extinction " + ShortText(SprayExtinction_per_m(spec.weather, MpsFromKmph(100.0))) +
         " per m at a train of 100 km/h";
}

// Sunlight.

bool HasSunlight(const DetectorSpec& spec) {
  return spec.weather.sun.illuminance_klx > 0.0;
}

std::string SunlightText(const DetectorSpec& spec) {
  const SunSpec& sun = spec.weather.sun;
  return NumberText(sun.illuminance_klx) + " klx, false alarms in " +
         ShortText(FalseAlarmProbability(sun)) + " of the firings";
}

Loop SunlightLoop(const DetectorSpec& spec, const Kernels& kernels) {
  const SunlightParameters parameters{static_cast<float>(SunBackgroundGain(spec.weather.sun))};
  return [=, apply = kernels.sunlight](DetectTile& tile) { apply(tile, parameters); };
}

// Range noise and channel bias act in the measurement, pointing jitter acts when beams are aimed.

bool HasRangeNoise(const DetectorSpec& spec) {
  return spec.receiver.range_noise_floor_m > 0.0 || spec.receiver.range_noise_scale_m > 0.0;
}

std::string RangeNoiseText(const DetectorSpec& spec) {
  const ReceiverSpec& receiver = spec.receiver;
  const double at_threshold_m =
      std::hypot(receiver.range_noise_floor_m,
                 receiver.range_noise_scale_m / std::sqrt(2.0 * receiver.snr_at_threshold));
  return "sigma " + NumberText(receiver.range_noise_floor_m) + " m, at the threshold " +
         ShortText(at_threshold_m) + " m";
}

bool HasChannelBias(const DetectorSpec& spec) {
  return spec.receiver.channel_bias_sigma_m > 0.0;
}

std::string ChannelBiasText(const DetectorSpec& spec) {
  return "sigma " + NumberText(spec.receiver.channel_bias_sigma_m) + " m";
}

bool HasPointingJitter(const DetectorSpec& spec) {
  return spec.receiver.pointing_jitter_deg > 0.0;
}

std::string PointingJitterText(const DetectorSpec& spec) {
  return "sigma " + NumberText(spec.receiver.pointing_jitter_deg) + " deg";
}

// Dead time acts where the echoes of a firing become returns.

bool HasDeadTime(const DetectorSpec& spec) {
  return spec.receiver.dead_time_ns > 0.0;
}

std::string DeadTimeText(const DetectorSpec& spec) {
  return NumberText(spec.receiver.dead_time_ns) + " ns, " + ShortText(DeadLength_m(spec.receiver)) +
         " m behind an echo";
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): a table
std::vector<Effect> PhysicalEffects() {
  const std::vector<Fidelity> from_surface_on{Fidelity::kSurface, Fidelity::kFootprint,
                                              Fidelity::kReference};
  return {
      {.name = "surface_response",
       .is_on = &EffectSet::surface_response,
       .rungs = from_surface_on,
       .has_cause = Always,
       .instructions = 246.0},
      {.name = "surface_condition",
       .is_on = &EffectSet::surface_condition,
       .rungs = from_surface_on,
       .has_cause = HasSurfaceCondition,
       .text = &SurfaceConditionText,
       .weather_keys = {"wetness", "rain_rate_mmph", "snow_cover"},
       .instructions = 10.0},
      {.name = "texture",
       .is_on = &EffectSet::texture,
       .rungs = from_surface_on,
       .has_cause = HasTexture,
       .text = &TextureText},
      {.name = "extinction",
       .is_on = &EffectSet::extinction,
       .rungs = from_surface_on,
       .has_cause = HasExtinction,
       .text = &ExtinctionText,
       .weather_keys = {"fog_density_per_m", "visibility_m", "rain_rate_mmph", "rain_drop_sizes",
                        "snow_rate_mmph", "snow_type"},
       .loops = {{StepOrder::kExtinction, &ExtinctionLoop}},
       .instructions = 30.0},
      {.name = "pulse_stretch",
       .is_on = &EffectSet::pulse_stretch,
       .rungs = from_surface_on,
       .has_cause = Always,
       .text = &PulseStretchText,
       .loops = {{StepOrder::kPulseStretch, &PulseStretchLoop}},
       .instructions = 10.0},
      {.name = "mirror_paths",
       .is_on = &EffectSet::mirror_paths,
       .rungs = from_surface_on,
       .has_cause = HasMirrorPaths,
       .text = &MirrorPathsText,
       .weather_keys = {"puddle_share"},
       .labels = {{"mirror_image", &ClutterLabels::mirror_image}}},
      {.name = "detection",
       .is_on = &EffectSet::detection,
       .rungs = from_surface_on,
       .has_cause = Always,
       .text = &DetectionText,
       .loops = {{StepOrder::kDetection, &DetectionLoop}},
       .instructions = 35.0},
      {.name = "detection_probability",
       .is_on = &EffectSet::detection_probability,
       .rungs = from_surface_on,
       .has_cause = Always,
       .text = &DetectionProbabilityText,
       .instructions = 55.0},
      {.name = "clutter",
       .is_on = &EffectSet::clutter,
       .rungs = from_surface_on,
       .has_cause = HasClutter,
       .text = &ClutterText,
       .weather_keys = {"rain_rate_mmph", "rain_drop_sizes", "snow_rate_mmph"},
       .labels = {{"rain", &ClutterLabels::rain}, {"snow", &ClutterLabels::snow}}},
      {.name = "fog_echo",
       .is_on = &EffectSet::fog_echo,
       .rungs = from_surface_on,
       .has_cause = HasFogEcho,
       .text = &FogEchoText,
       .weather_keys = {"fog_density_per_m", "visibility_m", "fog_variation"},
       .labels = {{"fog", &ClutterLabels::fog}}},
      {.name = "spray",
       .is_on = &EffectSet::spray,
       .rungs = from_surface_on,
       .has_cause = HasSpray,
       .text = &SprayText,
       .weather_keys = {"spray_extinction_per_m", "wetness", "rain_rate_mmph", "snow_cover"},
       .labels = {{"spray", &ClutterLabels::spray}}},
      {.name = "sunlight",
       .is_on = &EffectSet::sunlight,
       .rungs = from_surface_on,
       .has_cause = HasSunlight,
       .text = &SunlightText,
       .weather_keys = {"sun"},
       // The receiver raises false alarms in the dark, too.
       .labels = {{"false_alarm", &ClutterLabels::false_alarm, &Always}},
       .loops = {{StepOrder::kSunlight, &SunlightLoop}}},
      {.name = "range_noise",
       .is_on = &EffectSet::range_noise,
       .rungs = from_surface_on,
       .has_cause = HasRangeNoise,
       .text = &RangeNoiseText,
       .is_measurement_error = true},
      {.name = "channel_bias",
       .is_on = &EffectSet::channel_bias,
       .rungs = from_surface_on,
       .has_cause = HasChannelBias,
       .text = &ChannelBiasText,
       .is_measurement_error = true},
      {.name = "pointing_jitter",
       .is_on = &EffectSet::pointing_jitter,
       .rungs = from_surface_on,
       .has_cause = HasPointingJitter,
       .text = &PointingJitterText},
      {.name = "dead_time",
       .is_on = &EffectSet::dead_time,
       .rungs = from_surface_on,
       .has_cause = HasDeadTime,
       .text = &DeadTimeText},
  };
}

}  // namespace railcast
