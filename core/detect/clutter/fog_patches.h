#pragma once

#include <array>
#include <cstdint>

#include "core/detect/base/effect_parameters.h"
#include "railcast/transform.h"

namespace railcast {

/// The density of fog's droplets, which varies from place to place: log-normal, with mean 1,
///
///   density = exp(sigma g - sigma^2 / 2),  g = sum over waves of a cos(2 pi (k p + phi))
///
/// where sigma is `fog_variation`. The 12 waves have wavelengths from 3 to 60 m in equal ratios and
/// variances a^2 / 2 in proportion to wavelength^(2/3), as what turbulence mixes has (Kolmogorov's
/// law); their directions and phases are drawn once. Over all seeds, g has mean 0, variance 1 and
/// as correlation the mean of sin(x) / x, x = 2 pi distance / wavelength, weighted by variance. The
/// whole field moves with the wind, or with an air movement of 0.6 m/s if there is no wind.
///
/// A function of seed, place and time alone, so that all sensors of a vehicle and all its frames
/// see the same patches. Wavelengths and the movement of calm air are ours.
class FogPatches {
 public:
  /// The drift of the patches where the weather has no wind.
  static Vector3 CalmDrift_mps() { return {0.5, 0.33, 0.0}; }

  explicit FogPatches(std::uint64_t seed, const Vector3& drift_mps = CalmDrift_mps());

  /// The waves in the frame of a tile's rays.
  [[nodiscard]] FogWaves WavesAt(const Transform& world_from_window, double time_s) const;

  static constexpr double kShortest_m = 3.0;
  static constexpr double kLongest_m = 60.0;
  /// Wavelength of a wave.
  [[nodiscard]] static double Wavelength_m(std::size_t wave);
  /// Variance of a wave; the sum over all waves is 1.
  [[nodiscard]] static double Variance(std::size_t wave);

 private:
  struct Wave {
    Vector3 turns_per_m;
    double phase_turns{};
    double amplitude{};
  };
  std::array<Wave, kNumFogWaves> waves_;
  Vector3 drift_mps_;
};

}  // namespace railcast
