#include "core/detect/clutter/clutter.h"

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/detect/base/beam_optics.h"
#include "core/detect/base/lane_random.h"
#include "core/detect/base/wind_velocity.h"
#include "core/detect/clutter/added_echo.h"
#include "core/detect/clutter/cover.h"
#include "core/detect/kernels/fog_field.h"
#include "railcast/outcome.h"

namespace railcast {
namespace {

// Whether the pulse leaves the vehicle and reaches this range before the first surface, and so far
// before it that a receiver tells the two apart.
bool Reaches(const DetectTile& first, std::size_t beam, float range_m, float same_echo_m) {
  // The range of a missing surface is NaN, which fails the comparison: nothing is behind it.
  return first.outcome[beam] != static_cast<std::uint32_t>(Outcome::kEgo) &&
         !(range_m >= first.true_range_m[beam] - same_echo_m);
}

}  // namespace

Clutter::Clutter(const DetectorSpec& spec, const Kernels& kernels)
    : spec_(spec),
      uniforms_(kernels.uniforms),
      find_fog_peaks_(kernels.fog_peaks),
      fog_patches_(spec.air_seed,
                   spec.weather.wind_speed_mps > 0.0 ? WindVelocity_mps(spec.weather)
                                                     : FogPatches::CalmDrift_mps()),
      extinction_per_m_(
          static_cast<float>(Extinction_per_m(spec.weather, spec.beam.wavelength_nm))) {
  power_min_ = LeastPower(spec.receiver);
  if (spec.effects.clutter && spec.weather.rain_rate_mmph > 0.0) {
    drops_ = MakePopulation(RainDropSizes(spec.weather), kDropReflectance, spec.clutter_labels.rain,
                            EchoTiles::kFirstDrop);
  }
  if (spec.effects.clutter && spec.weather.snow_rate_mmph > 0.0) {
    flakes_ = MakePopulation(SnowFlakeSizes(spec.weather), kFlakeReflectance,
                             spec.clutter_labels.snow, EchoTiles::kFirstFlake);
  }
  if (spec.effects.fog_echo) fog_ = FogProfileOf(spec);
  if (spec.effects.sunlight) {
    false_alarm_probability_ = static_cast<float>(FalseAlarmProbability(spec.weather.sun));
  }
}

Clutter::Population Clutter::MakePopulation(const ParticleSizes& sizes,
                                            double reflectance,
                                            std::uint32_t label,
                                            std::uint32_t first_echo) const {
  Population population;
  population.echoes = ParticleEchoesOf(sizes, reflectance, spec_.beam, power_min_);
  population.label = label;
  population.first_echo = first_echo;
  const double mean = population.echoes.mean_count * spec_.receiver.clutter_gain;
  population.is_on = mean > 0.0;
  double probability = std::exp(-mean);
  double at_most = probability;
  for (std::size_t n = 0; n < kMostParticles; ++n) {
    population.at_most[n] = static_cast<float>(at_most);
    probability *= mean / static_cast<double>(n + 1);
    at_most += probability;
  }
  return population;
}

void Clutter::AddPopulation(const Population& population, EchoTiles& echoes) const {
  if (!population.is_on) return;
  const DetectTile& first = echoes.first;
  // Each particle's range and size have random keys of their own, apart from that of the count.
  const auto words_of = [&](std::size_t beam, std::uint32_t block) {
    return RandomWords(spec_.seed, RandomUse::kClutter, first.frame, first.firing[beam], block);
  };
  alignas(64) float counts[kTileSize];
  uniforms_(first, {spec_.seed, RandomUse::kClutter, 2 * population.first_echo}, counts);
  const auto range_scale_m = static_cast<float>(population.echoes.range_scale_m);
  const auto b = static_cast<float>(population.echoes.least_diameter_per_m2);
  const auto same_echo_m = static_cast<float>(2.0 * PulseSigma_m(spec_.beam));
  for (std::size_t beam = 0; beam < first.num_rays; ++beam) {
    for (std::uint32_t n = 0; n < kMostParticles && counts[beam] >= population.at_most[n]; ++n) {
      const std::uint32_t block = 2 * (population.first_echo + n) + 1;
      const auto places = words_of(beam, block);
      const auto normals = baseline::LaneNormals({places[0], places[1], places[2], places[3]});
      const float r = range_scale_m * std::sqrt(normals.a * normals.a + normals.b * normals.b +
                                                normals.c * normals.c);
      if (static_cast<double>(r) < spec_.range_min_m || !Reaches(first, beam, r, same_echo_m)) {
        continue;
      }
      // Above the least detectable diameter, diameters are exponentially distributed. The power is
      // proportional to the square of the diameter.
      const float v = UnitFloat(words_of(beam, block + 1)[0]);
      const float diameter = 1.0F - baseline::Log(1.0F - v) / (b * r * r);
      const float both_ways_per_m = spec_.effects.extinction ? 2.0F * extinction_per_m_ : 0.0F;
      const float ratio = diameter * diameter * baseline::Exp(-both_ways_per_m * r);
      if (ratio < kLeastStrayRatio) continue;
      AddEcho(beam,
              {population.label, population.first_echo + n, r, ratio,
               IntensityInClearAir(ratio, static_cast<float>(power_min_), both_ways_per_m, r)},
              echoes);
    }
  }
}

void Clutter::AddParticles(EchoTiles& echoes) const {
  AddPopulation(drops_, echoes);
  AddPopulation(flakes_, echoes);
}

void Clutter::AddFogEchoes(const AirView& air, EchoTiles& echoes) const {
  if (!has_fog_echo()) return;
  const EffectSet& effects = spec_.effects;
  const bool is_noisy = effects.detection_probability || !effects.detection;
  const double noise = is_noisy ? 1.0 / spec_.receiver.snr_at_threshold : 0.0;
  const FogNoiseWeights weights = FogNoiseOf(spec_.beam, fog_.gate_m);
  const FogEchoParameters parameters{
      .seed = spec_.seed,
      .first_gate = static_cast<std::uint32_t>(fog_.first_gate),
      .num_gates = static_cast<std::uint32_t>(fog_.ratio.size()),
      .gate_m = static_cast<float>(fog_.gate_m),
      .mean_ratio = fog_.ratio.data(),
      .least_ratio = static_cast<float>(kLeastFogRatio),
      .noise_own = static_cast<float>(noise * weights.own),
      .noise_beside = static_cast<float>(noise * weights.beside),
      .variation = static_cast<float>(spec_.weather.fog_variation),
      .range_min_m = static_cast<float>(spec_.range_min_m),
      .merge_m = static_cast<float>(PulseLength_m(spec_.beam)),
      // A receiver that reports the strongest echo alone looks for the highest peak alone.
      .num_peaks = spec_.receiver.return_mode == ReturnMode::kStrongest ? 1U : kNumFogEchoes,
      .threshold = effects.detection ? 1.0F : 0.0F,
      .is_behind_cover = effects.cover && HasCover(spec_)};
  FogPeaks peaks;
  const FogWaves waves = fog_patches_.WavesAt(air.world_from_window, air.time_s);
  find_fog_peaks_({air.rays, echoes.first, waves}, parameters, peaks);
  const auto power_min = static_cast<float>(power_min_);
  for (std::uint32_t e = 0; e < parameters.num_peaks; ++e) {
    for (std::size_t beam = 0; beam < echoes.first.num_rays; ++beam) {
      const float ratio = peaks.ratio[e][beam];
      if (ratio <= 0.0F) continue;
      const float r = peaks.range_m[e][beam];
      const float intensity = IntensityInClearAir(ratio, power_min, 2.0F * extinction_per_m_, r);
      const auto [tile, lane] =
          AddEcho(beam, {spec_.clutter_labels.fog, kFirstFogEcho + e, r, ratio, intensity}, echoes);
      tile.cover[lane] = 1.0F;  // The light has come through the window already.
    }
  }
}

void Clutter::AddFalseAlarms(EchoTiles& echoes) const {
  if (!has_false_alarms()) return;
  const DetectTile& first = echoes.first;
  alignas(64) float alarms[kTileSize];
  uniforms_(first, {spec_.seed, RandomUse::kFalseAlarm, 0}, alarms);
  for (std::size_t beam = 0; beam < first.num_rays; ++beam) {
    if (alarms[beam] >= false_alarm_probability_) continue;
    const auto words =
        RandomWords(spec_.seed, RandomUse::kFalseAlarm, first.frame, first.firing[beam], 1);
    const auto range_m = static_cast<float>(
        std::lerp(spec_.range_min_m, spec_.range_max_m, static_cast<double>(UnitFloat(words[0]))));
    AddMeasuredEcho(beam,
                    {spec_.clutter_labels.false_alarm, EchoTiles::kFalseAlarm, range_m, 1.0F,
                     static_cast<float>(power_min_) * range_m * range_m},
                    echoes);
  }
}

double ListeningTime_s(const DetectorSpec& spec) {
  return 2.0 * (spec.range_max_m - spec.range_min_m) / kSpeedOfLight_mps;
}

Interference::Interference(const DetectorSpec& spec, const Kernels& kernels)
    : spec_(spec), uniforms_(kernels.uniforms) {
  if (!spec.effects.interference) return;
  if (spec.effects.saturation) {
    saturation_ = static_cast<float>(spec.receiver.saturation_power_ratio.value_or(0.0));
    pulse_sigma_m_ = static_cast<float>(PulseSigma_m(spec.beam));
  }
  probability_ =
      static_cast<float>(-std::expm1(-spec.receiver.foreign_pulses_hz * ListeningTime_s(spec)));
}

void Interference::AddEchoes(EchoTiles& echoes) const {
  if (!is_on()) return;
  const DetectTile& first = echoes.first;
  const auto power_min = static_cast<float>(LeastPower(spec_.receiver));
  alignas(64) float arrivals[kTileSize];
  uniforms_(first, {spec_.seed, RandomUse::kInterference, 0}, arrivals);
  for (std::size_t beam = 0; beam < first.num_rays; ++beam) {
    if (arrivals[beam] >= probability_) continue;
    const auto words =
        RandomWords(spec_.seed, RandomUse::kInterference, first.frame, first.firing[beam], 1);
    const auto range_m = static_cast<float>(
        std::lerp(spec_.range_min_m, spec_.range_max_m, static_cast<double>(UnitFloat(words[0]))));
    const float ratio = 1.0F / (1.0F - UnitFloat(words[1]));
    AddedEcho echo{spec_.clutter_labels.false_alarm, EchoTiles::kForeignPulse, range_m, ratio,
                   ratio * power_min * range_m * range_m};
    if (saturation_ > 0.0F) {
      echo.power_ratio = std::min(ratio, saturation_);
      echo.busy_m = pulse_sigma_m_ * std::sqrt(2.0F * std::log(ratio));
    }
    AddMeasuredEcho(beam, echo, echoes);
  }
}

}  // namespace railcast
