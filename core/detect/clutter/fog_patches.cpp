#include "core/detect/clutter/fog_patches.h"

#include <cmath>
#include <numbers>

#include "core/base/random.h"

namespace railcast {

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

}  // namespace railcast
