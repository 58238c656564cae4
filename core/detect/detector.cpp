#include "core/detect/detector.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "core/base/random.h"
#include "core/detect/beam_optics.h"
#include "core/detect/lane_random.h"
#include "core/detect/surface_response.h"
#include "core/detect/weather_optics.h"

namespace railcast {
namespace {

ThresholdParameters MakeThreshold(const DetectorSpec& spec) {
  const PlausibilitySpec& model = spec.plausibility;
  return {.inverse_threshold_m2 = static_cast<float>(
              model.reference_range_m * model.reference_range_m / model.reference_threshold),
          .fog_density_per_m = static_cast<float>(FogExtinction_per_m(spec.weather))};
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
          .label = spec.labels.snow,
          .threshold = MakeThreshold(spec)};
}

ResponseParameters MakeResponse(const DetectorSpec& spec) {
  const LaneOptics snow = LaneOpticsOf(spec.snow);
  return {.is_lambert = !spec.effects.surface_response,
          .inverse_power_m2 = static_cast<float>(1.0 / LeastPower(spec.receiver)),
          .snow_cover =
              spec.effects.surface_condition ? static_cast<float>(spec.weather.snow_cover) : 0.0F,
          .snow_a = snow.a,
          .snow_b = snow.b};
}

// N(0, sigma), the same in every frame.
std::vector<float> MakeChannelBias(const DetectorSpec& spec) {
  std::vector<float> bias_m(spec.num_channels, 0.0F);
  if (!spec.effects.channel_bias) return bias_m;
  for (std::uint32_t channel = 0; channel < spec.num_channels; ++channel) {
    const auto words = RandomWords(spec.seed, RandomUse::kChannelBias, 0, channel);
    bias_m[channel] = static_cast<float>(spec.receiver.channel_bias_sigma_m) *
                      baseline::LaneNormals({words[0], words[1], words[2], words[3]}).a;
  }
  return bias_m;
}

EffectStep MakeMeasurement(const DetectorSpec& spec,
                           const std::vector<float>& channel_bias_m,
                           const Kernels& kernels) {
  MeasurementParameters parameters{.seed = spec.seed,
                                   .sigma0_m = static_cast<float>(spec.plausibility.noise_sigma0_m),
                                   .sigma1 = static_cast<float>(spec.plausibility.noise_sigma1),
                                   .range_min_m = static_cast<float>(spec.range_min_m),
                                   .range_max_m = static_cast<float>(spec.range_max_m),
                                   .channel_bias_m = channel_bias_m.data()};
  auto* measure = kernels.measure_exact;
  if (spec.effects.noise) {
    measure = spec.plausibility.noise_shape == "beam" ? kernels.measure_along_beam
                                                      : kernels.measure_isotropic;
  }
  const bool is_noisy = spec.effects.range_noise;
  if (IsPhysical(spec.effects)) {
    const ReceiverSpec& receiver = spec.receiver;
    measure = kernels.measure_by_signal;
    parameters.sigma0_m = is_noisy ? static_cast<float>(receiver.range_noise_floor_m) : 0.0F;
    parameters.sigma1 = 0.0F;
    parameters.scale_m = is_noisy ? static_cast<float>(receiver.range_noise_scale_m) : 0.0F;
    parameters.snr_at_threshold = static_cast<float>(receiver.snr_at_threshold);
  }
  const std::string_view effect = spec.effects.noise          ? "noise"
                                  : is_noisy                  ? "range_noise"
                                  : spec.effects.channel_bias ? "channel_bias"
                                                              : "measurement";
  return {effect, [=](DetectTile& tile) { measure(tile, parameters); }};
}

// Without the threshold no power is computed: the fields say so.
void LeavePowerOut(DetectTile& tile) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  std::fill_n(tile.intensity, tile.num_rays, kNaN);
  std::fill_n(tile.power_ratio, tile.num_rays, kNaN);
}

// What the published model does between hit and measurement. An effect whose cause is absent is
// left out: no rain, no snow, no work.
void AddPublishedSteps(const DetectorSpec& spec,
                       const Kernels& kernels,
                       std::vector<EffectStep>& steps) {
  if (spec.effects.threshold) {
    steps.push_back({"threshold", [p = MakeThreshold(spec), apply = kernels.threshold](
                                      DetectTile& tile) { apply(tile, p); }});
  } else if (!IsPhysical(spec.effects)) {
    steps.push_back({"no threshold", &LeavePowerOut});
  }
  if (spec.effects.rain && spec.weather.rain_rate_mmph > 0.0) {
    steps.push_back(
        {"rain", [p = MakeRain(spec), apply = kernels.rain](DetectTile& tile) { apply(tile, p); }});
  }
  if (spec.effects.snow && spec.weather.snow_rate_mmph > 0.0) {
    steps.push_back(
        {"snow", [p = MakeSnow(spec), apply = kernels.snow](DetectTile& tile) { apply(tile, p); }});
  }
}

void AddPhysicalSteps(const DetectorSpec& spec,
                      const Kernels& kernels,
                      std::vector<EffectStep>& steps) {
  if (spec.effects.sunlight && spec.weather.sun.illuminance_klx > 0.0) {
    const SunlightParameters parameters{static_cast<float>(SunBackgroundGain(spec.weather.sun))};
    steps.push_back(
        {"sunlight", [=, apply = kernels.sunlight](DetectTile& tile) { apply(tile, parameters); }});
  }
  if (spec.effects.detection) {
    const DetectionParameters parameters{
        .seed = spec.seed, .snr_at_threshold = static_cast<float>(spec.receiver.snr_at_threshold)};
    auto* const apply =
        spec.effects.detection_probability ? kernels.smooth_detection : kernels.detection;
    steps.push_back({"detection", [=](DetectTile& tile) { apply(tile, parameters); }});
  }
}

std::vector<EffectStep> MakeReceiver(const DetectorSpec& spec,
                                     const std::vector<float>& channel_bias_m,
                                     const Kernels& kernels) {
  std::vector<EffectStep> steps;
  const auto range_min_m = static_cast<float>(spec.range_min_m);
  steps.push_back({"hit", [=, hit = kernels.hit](DetectTile& tile) { hit(tile, range_min_m); }});
  // First: a pulse that was never sent meets neither surface nor snow.
  if (spec.effects.sensor_dropout && spec.plausibility.dropout_probability > 0.0) {
    const SensorDropoutParameters parameters{
        .seed = spec.seed,
        .probability = static_cast<float>(spec.plausibility.dropout_probability)};
    steps.push_back({"sensor_dropout", [=, apply = kernels.sensor_dropout](DetectTile& tile) {
                       apply(tile, parameters);
                     }});
  }
  AddPublishedSteps(spec, kernels, steps);
  AddPhysicalSteps(spec, kernels, steps);
  steps.push_back(MakeMeasurement(spec, channel_bias_m, kernels));
  return steps;
}

}  // namespace

bool IsPhysical(const EffectSet& effects) {
  EffectSet published;
  published.threshold = effects.threshold;
  published.rain = effects.rain;
  published.snow = effects.snow;
  published.noise = effects.noise;
  published.sensor_dropout = effects.sensor_dropout;
  return effects != published;
}

Detector::Detector(const DetectorSpec& spec, const Kernels& kernels)
    : response_(MakeResponse(spec)),
      pulse_sigma_m_(static_cast<float>(PulseSigma_m(spec.beam))),
      has_stretch_(spec.effects.pulse_stretch),
      extinction_per_m_(spec.effects.extinction ? static_cast<float>(Extinction_per_m(
                                                      spec.weather, spec.beam.wavelength_nm))
                                                : 0.0F),
      channel_bias_m_(MakeChannelBias(spec)),
      clutter_(spec, kernels) {
  if (IsPhysical(spec.effects)) AddOptics(kernels);
  receiver_ = MakeReceiver(spec, channel_bias_m_, kernels);
}

void Detector::AddOptics(const Kernels& kernels) {
  optics_.push_back({"surface_response", [p = response_, apply = kernels.response](
                                             DetectTile& tile) { apply(tile, p); }});
  if (has_stretch_) {
    optics_.push_back({"pulse_stretch", [sigma_m = pulse_sigma_m_, apply = kernels.pulse_stretch](
                                            DetectTile& tile) { apply(tile, sigma_m); }});
  }
  if (extinction_per_m_ > 0.0F) {
    optics_.push_back({"extinction", [alpha = extinction_per_m_, apply = kernels.extinction](
                                         DetectTile& tile) { apply(tile, alpha); }});
  }
}

float Detector::Reflectance(const LaneOptics& optics, float cosine) const {
  if (response_.is_lambert) return optics.diffuse * cosine;
  return baseline::EffectiveReflectance(optics, cosine);
}

float Detector::PowerRatio(float intensity, float range_m, float spread_m) const {
  float ratio = intensity * response_.inverse_power_m2 / (range_m * range_m);
  if (has_stretch_) ratio *= pulse_sigma_m_ / std::hypot(pulse_sigma_m_, spread_m);
  return ratio * baseline::Exp(-2.0F * extinction_per_m_ * range_m);
}

void Detector::Respond(DetectTile& tile, const EffectObserver& observer) const {
  for (const EffectStep& step : optics_) {
    step.apply(tile);
    if (observer) observer(step.effect);
  }
}

void Detector::Detect(EchoTiles& echoes, const EffectObserver& observer) const {
  clutter_.Add(echoes);
  for (const EffectStep& step : receiver_) {
    echoes.ForEachTile(step.apply);
    if (observer) observer(step.effect);
  }
  clutter_.AddFalseAlarms(echoes);
}

}  // namespace railcast
