#include "core/detect/clutter/fog_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/detect/base/beam_optics.h"
#include "core/detect/base/weather_optics.h"

namespace railcast {
namespace {

// Gain of the receiver over the square of the range.
double GainOverSquare_per_m2(double near_range_m, double range_m) {
  const double sum_m2 = range_m * range_m + near_range_m * near_range_m;
  return range_m * range_m / (sum_m2 * sum_m2);
}

}  // namespace

double FogPatches::Wavelength_m(std::size_t wave) {
  const double share = static_cast<double>(wave) / static_cast<double>(kNumFogWaves - 1);
  return kShortest_m * std::pow(kLongest_m / kShortest_m, share);
}

double FogPatches::Variance(std::size_t wave) {
  double sum = 0.0;
  for (std::size_t i = 0; i < kNumFogWaves; ++i) sum += std::pow(Wavelength_m(i), 2.0 / 3.0);
  return std::pow(Wavelength_m(wave), 2.0 / 3.0) / sum;
}

FogPatches::FogPatches(std::uint64_t seed, const Vector3& drift_mps) : drift_mps_(drift_mps) {
  for (std::size_t i = 0; i < kNumFogWaves; ++i) {
    const auto words = RandomWords(seed, RandomUse::kFogPatches, 0, static_cast<std::uint32_t>(i));
    const double azimuth_rad = 2.0 * std::numbers::pi * static_cast<double>(UnitFloat(words[0]));
    const double z = 2.0 * static_cast<double>(UnitFloat(words[1])) - 1.0;
    const double across = std::sqrt(1.0 - z * z);
    const Vector3 direction(across * std::cos(azimuth_rad), across * std::sin(azimuth_rad), z);
    waves_[i] = {direction / Wavelength_m(i), static_cast<double>(UnitFloat(words[2])),
                 std::sqrt(2.0 * Variance(i))};
  }
}

FogWaves FogPatches::WavesAt(const Transform& world_from_window, double time_s) const {
  const Vector3 origin_m = world_from_window.translation() - time_s * drift_mps_;
  FogWaves waves;
  for (std::size_t i = 0; i < kNumFogWaves; ++i) {
    const Vector3 here = world_from_window.linear().transpose() * waves_[i].turns_per_m;
    waves.x[i] = static_cast<float>(here.x());
    waves.y[i] = static_cast<float>(here.y());
    waves.z[i] = static_cast<float>(here.z());
    // World coordinates and times are large: only the fraction of a turn fits into float32.
    const double phase = waves_[i].turns_per_m.dot(origin_m) + waves_[i].phase_turns;
    waves.amplitude[i] = static_cast<float>(waves_[i].amplitude);
    waves.phase[i] = static_cast<float>(phase - std::floor(phase));
  }
  return waves;
}

double NearRange_m(const ReceiverSpec& receiver) {
  constexpr double kShareOfRange = 0.045;
  return receiver.near_range_m.value_or(kShareOfRange * receiver.range_at_10_percent_m);
}

double MeanFogRatio(const DetectorSpec& spec, double range_m) {
  constexpr double kLidarRatio_sr = 65.0;
  constexpr int kSteps = 80;
  constexpr double kReach = 5.0;  // In standard deviations of the pulse.
  const double extinction_per_m = Extinction_per_m(spec.weather, spec.beam.wavelength_nm);
  const double backscatter_per_m = FogExtinction_per_m(spec.weather) / kLidarRatio_sr;
  const double near_range_m = NearRange_m(spec.receiver);
  const double sigma_m = PulseSigma_m(spec.beam);
  const double step_m = 2.0 * kReach * sigma_m / kSteps;
  // The trapezoidal rule over a Gaussian converges faster than any power of the step. Its ends
  // weigh 4e-6 and count in full.
  double sum_per_m2 = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double z = kReach * (2.0 * i / kSteps - 1.0);
    const double r = range_m + z * sigma_m;
    if (r <= 0.0) continue;
    sum_per_m2 += std::exp(-0.5 * z * z - 2.0 * extinction_per_m * r) *
                  GainOverSquare_per_m2(near_range_m, r);
  }
  return spec.receiver.fog_gain * std::numbers::pi * backscatter_per_m * step_m * sum_per_m2 /
         LeastPower(spec.receiver);
}

double DensestPatch(const WeatherSpec& weather) {
  const double sigma = weather.fog_variation;
  return std::exp(3.0 * sigma - 0.5 * sigma * sigma);
}

FogNoiseWeights FogNoiseOf(const BeamSpec& beam, double gate_m) {
  const double sigmas = gate_m / (2.0 * PulseSigma_m(beam));
  const double neighbours = std::exp(-sigmas * sigmas);
  // own^2 + 2 beside^2 = 1 and 2 own beside = neighbours. At half a pulse length, the root is 0.
  const double root = std::sqrt(std::max(1.0 - 2.0 * neighbours * neighbours, 0.0));
  return {.own = std::sqrt(0.5 * (1.0 + root)), .beside = 0.5 * std::sqrt(1.0 - root)};
}

FogProfile FogProfileOf(const DetectorSpec& spec) {
  if (FogExtinction_per_m(spec.weather) <= 0.0 || spec.receiver.fog_gain <= 0.0) return {};
  const double pulse_m = PulseLength_m(spec.beam);
  const double gate_m = 0.5 * pulse_m;
  const double least = kLeastFogRatio / DensestPatch(spec.weather);
  // Beyond the near range the echo falls faster than 1 / r^2, so that doubling finds its end.
  const auto is_seen = [&](double r) { return MeanFogRatio(spec, r) >= least; };
  constexpr int kSamples = 256;
  double search_m = 4.0 * NearRange_m(spec.receiver) + pulse_m;
  while (is_seen(search_m) && search_m < spec.range_max_m) search_m *= 2.0;
  double begin_m = 0.0;
  double reach_m = 0.0;
  for (int i = 1; i <= kSamples; ++i) {
    const double r = search_m * i / kSamples;
    if (!is_seen(r)) continue;
    if (begin_m <= 0.0) begin_m = r;
    reach_m = r;
  }
  if (reach_m < spec.range_min_m || reach_m <= 0.0) return {};
  FogProfile profile;
  profile.gate_m = std::max(gate_m, reach_m / static_cast<double>(kMostFogGates - 2));
  // One gate more on either side than is seen, with which the others are compared.
  const auto gate_at = [&](double r) {
    return static_cast<std::size_t>(std::lround(r / profile.gate_m));
  };
  profile.first_gate = gate_at(begin_m) - std::min<std::size_t>(gate_at(begin_m), 2);
  const std::size_t end = gate_at(reach_m) + 1;
  for (std::size_t k = profile.first_gate; k < end; ++k) {
    const double r = (static_cast<double>(k) + 0.5) * profile.gate_m;
    profile.ratio.push_back(static_cast<float>(MeanFogRatio(spec, r)));
  }
  return profile;
}

}  // namespace railcast
