#include "core/detect/detector/detector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "core/base/random.h"
#include "core/detect/base/beam_optics.h"
#include "core/detect/base/lane_random.h"
#include "core/detect/base/weather_optics.h"
#include "core/detect/kernels/measurement.h"
#include "core/detect/kernels/surface_response.h"
#include "railcast/outcome.h"

namespace railcast {
namespace {

/// A loop and its place in the order of loops.
struct PlacedStep {
  StepOrder order{};
  EffectStep step;
};

ResponseParameters MakeResponse(const DetectorSpec& spec, const SurfaceOptics& snow_optics) {
  const LaneOptics snow = LaneOpticsOf(snow_optics);
  return {.is_lambert = !spec.effects.surface_response,
          .inverse_power_m2 = static_cast<float>(1.0 / LeastPower(spec.receiver)),
          .snow_cover =
              spec.effects.surface_condition ? static_cast<float>(spec.weather.snow_cover) : 0.0F,
          .snow_a = snow.a,
          .snow_b = snow.b};
}

// Draws the channels' constant range errors from N(0, sigma). They are the same in every frame.
std::vector<float> MakeChannelBias(const DetectorSpec& spec, std::uint32_t num_channels) {
  std::vector<float> bias_m(num_channels, 0.0F);
  if (!spec.effects.channel_bias) return bias_m;
  for (std::uint32_t channel = 0; channel < num_channels; ++channel) {
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
    measure = spec.plausibility.noise_shape == NoiseShape::kBeam ? kernels.measure_along_beam
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

// Without effect `threshold` no power is computed, which NaN marks.
void LeavePowerOut(DetectTile& tile) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  std::fill_n(tile.intensity, tile.num_rays, kNaN);
  std::fill_n(tile.power_ratio, tile.num_rays, kNaN);
}

// The loops of the effects that are on and have a cause. Without rain, for example, effect `rain`
// adds no loop.
std::vector<PlacedStep> MakeEffectLoops(const DetectorSpec& spec, const Kernels& kernels) {
  std::vector<PlacedStep> steps;
  for (const Effect& effect : EffectTable()) {
    if (!(spec.effects.*effect.is_on) || effect.loops.empty() || !effect.has_cause(spec)) continue;
    for (const EffectLoop& loop : effect.loops) {
      steps.push_back({loop.order, {effect.name, loop.make(spec, kernels)}});
    }
  }
  return steps;
}

// The loops that run whichever effects are on.
std::vector<PlacedStep> MakeBaseLoops(const DetectorSpec& spec,
                                      const ResponseParameters& response,
                                      const std::vector<float>& channel_bias_m,
                                      const Kernels& kernels) {
  std::vector<PlacedStep> steps;
  const auto range_min_m = static_cast<float>(spec.range_min_m);
  steps.push_back({StepOrder::kHit,
                   {"hit", [=, hit = kernels.hit](DetectTile& tile) { hit(tile, range_min_m); }}});
  if (IsPhysical(spec.effects)) {
    steps.push_back({StepOrder::kSurfaceResponse,
                     {ShowsSurfaceCondition(spec) ? "surface_condition" : "surface_response",
                      [=, apply = kernels.response](DetectTile& tile) { apply(tile, response); }}});
  } else if (!spec.effects.threshold) {
    steps.push_back({StepOrder::kThreshold, {"no threshold", &LeavePowerOut}});
  }
  steps.push_back({StepOrder::kMeasurement, MakeMeasurement(spec, channel_bias_m, kernels)});
  return steps;
}

}  // namespace

bool ShowsSurfaceCondition(const DetectorSpec& spec) {
  return spec.effects.surface_condition && FindEffect("surface_condition")->has_cause(spec);
}

void LoseBeamsAtEdges(const EdgeLossParameters& parameters, EchoTiles& echoes) {
  if (!(parameters.probability > 0.0F) || echoes.num_more() == 0) return;
  struct Part {
    float share = 0.0F;
    float range_m = 0.0F;
  };
  std::array<std::array<Part, 2>, kTileSize> largest{};
  const auto add = [&](const DetectTile& tile, std::size_t lane, std::size_t beam) {
    if (tile.clutter[lane] != kNoClutter || tile.surface[lane] == 0) return;
    auto& [first, second] = largest[beam];
    const Part part{tile.share[lane], tile.true_range_m[lane]};
    if (part.share > first.share) {
      second = std::exchange(first, part);
    } else if (part.share > second.share) {
      second = part;
    }
  };
  const DetectTile& firings = echoes.first;
  for (std::size_t i = 0; i < firings.num_rays; ++i) add(firings, i, i);
  for (std::size_t i = 0; i < echoes.num_more(); ++i) {
    const auto [tile, lane] = echoes.more(i);
    add(tile, lane, echoes.beam_of(i));
  }
  std::array<bool, kTileSize> is_lost{};
  for (std::size_t i = 0; i < firings.num_rays; ++i) {
    const auto& [first, second] = largest[i];
    const float jump_m = std::fabs(first.range_m - second.range_m);
    if (second.share == 0.0F || jump_m <= parameters.pulse_length_m) continue;
    const float straddles = 2.0F * second.share / (first.share + second.share);
    const float probability =
        parameters.probability * straddles * (1.0F - parameters.pulse_length_m / jump_m);
    const auto words =
        RandomWords(parameters.seed, RandomUse::kEdgeLoss, firings.frame, firings.firing[i]);
    is_lost[i] = UnitFloat(words[0]) < probability;
  }
  constexpr auto kLost = static_cast<std::uint32_t>(Outcome::kSensorDropout);
  for (std::size_t i = 0; i < firings.num_rays; ++i) {
    if (is_lost[i]) echoes.first.outcome[i] = kLost;
  }
  for (std::size_t i = 0; i < echoes.num_more(); ++i) {
    const auto [tile, lane] = echoes.more(i);
    if (is_lost[echoes.beam_of(i)]) tile.outcome[lane] = kLost;
  }
}

Detector::Detector(const DetectorSpec& spec, const DetectorSetting& setting, const Kernels& kernels)
    : response_(MakeResponse(spec, setting.snow)),
      pulse_sigma_m_(static_cast<float>(PulseSigma_m(spec.beam))),
      stretch_lowers_power_(StretchLowersPower(spec)),
      extinction_per_m_(spec.effects.extinction ? static_cast<float>(Extinction_per_m(
                                                      spec.weather, spec.beam.wavelength_nm))
                                                : 0.0F),
      channel_bias_m_(MakeChannelBias(spec, setting.num_channels)),
      clutter_(spec, kernels),
      ghost_(spec),
      edge_loss_{.seed = spec.seed,
                 .probability =
                     spec.effects.edge_loss ? static_cast<float>(spec.receiver.edge_loss) : 0.0F,
                 .pulse_length_m = static_cast<float>(PulseLength_m(spec.beam))},
      interference_(spec, kernels) {
  if (ShowsSurfaceCondition(spec)) {
    ResponseParameters bare = response_;
    bare.snow_cover = 0.0F;
    bare_response_ = {"surface_response",
                      [=, apply = kernels.response](DetectTile& tile) { apply(tile, bare); }};
  }
  std::vector<PlacedStep> steps = MakeBaseLoops(spec, response_, channel_bias_m_, kernels);
  for (PlacedStep& step : MakeEffectLoops(spec, kernels)) steps.push_back(std::move(step));
  std::stable_sort(steps.begin(), steps.end(),
                   [](const PlacedStep& a, const PlacedStep& b) { return a.order < b.order; });
  for (PlacedStep& step : steps) {
    (step.order < StepOrder::kHit ? optics_ : receiver_).push_back(std::move(step.step));
  }
}

float Detector::Reflectance(const LaneOptics& optics, float cosine) const {
  if (response_.is_lambert) return optics.diffuse * cosine;
  return baseline::EffectiveReflectance(optics, cosine);
}

float Detector::PowerRatio(float intensity, float range_m, float spread_m) const {
  float ratio = intensity * response_.inverse_power_m2 / (range_m * range_m);
  if (stretch_lowers_power_) ratio *= pulse_sigma_m_ / std::hypot(pulse_sigma_m_, spread_m);
  return ratio * baseline::Exp(-2.0F * extinction_per_m_ * range_m);
}

void Detector::RespondBare(DetectTile& tile, const EffectObserver& observer) const {
  bare_response_.apply(tile);
  observer(bare_response_.effect);
}

void Detector::Respond(DetectTile& tile, const EffectObserver& observer) const {
  for (const EffectStep& step : optics_) {
    step.apply(tile);
    if (observer) observer(step.effect);
  }
}

void Detector::Detect(const AirView& air, EchoTiles& echoes, const EffectObserver& observer) const {
  const auto tell = [&](bool is_on, std::string_view effect) {
    if (is_on && observer) observer(effect);
  };
  ghost_.AddEchoes(echoes);
  tell(ghost_.is_on(), "ghost");
  clutter_.AddParticles(echoes);
  tell(clutter_.has_particles(), "clutter");
  clutter_.AddFogEchoes(air, echoes);
  tell(clutter_.has_fog_echo(), "fog_echo");
  LoseBeamsAtEdges(edge_loss_, echoes);
  tell(edge_loss_.probability > 0.0F, "edge_loss");
  for (const EffectStep& step : receiver_) {
    echoes.ForEachTile(step.apply);
    tell(true, step.effect);
  }
  clutter_.AddFalseAlarms(echoes);
  tell(clutter_.has_false_alarms(), "false alarms");
  interference_.AddEchoes(echoes);
  tell(interference_.is_on(), "interference");
}

}  // namespace railcast
