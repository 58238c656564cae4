#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/detect/base/effect_parameters.h"
#include "railcast/effects.h"
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

/// Range at which the receiver has a quarter of its gain for the echoes of fog:
/// `near_range_m`, or 0.045 range_at_10_percent_m if it is absent. That share keeps the echo of
/// haze of 2 km visibility below a tenth of the threshold on every sensor (docs/physics.md 4.3).
[[nodiscard]] double NearRange_m(const ReceiverSpec& receiver);

/// The echo of fog of uniform density as a function of range, in units of the least detectable
/// power: the soft-target integral
///
///   fog_gain / P_min * pi beta * integral of p(r - r') g(r') exp(-2 alpha r') / r'^2 dr'
///   g(r) = (r^2 / (r^2 + near_range^2))^2,  beta = alpha_fog / 65 sr,
///   p = the pulse, a Gaussian of peak 1, alpha = extinction by fog, rain and snow
///
/// (docs/physics.md 4.3). The integral is a sum over the pulse from -5 to 5 standard deviations.
[[nodiscard]] double MeanFogRatio(const DetectorSpec& spec, double range_m);

/// Greatest value that local patches of fog give the density at three standard deviations.
[[nodiscard]] double DensestPatch(const WeatherSpec& weather);

/// Where fog answers with less than this share of the threshold it is not looked for: with the
/// default signal-to-noise ratio, noise would lift it above the threshold once in 8 km of beam.
inline constexpr double kLeastFogRatio = 0.2;

/// The gates in which fog can be detected: gate k is at range (k + 1/2) gate_m. Gates are half a
/// pulse length (full width at half maximum) apart; farther apart where it would take more than
/// kMostFogGates of them.
struct FogProfile {
  double gate_m{};
  std::size_t first_gate{};  ///< Nothing is seen in the gates before it.
  /// MeanFogRatio() at each gate from the first on; empty where no fog can be detected.
  std::vector<float> ratio;
};

/// Range of a gate, counted from the first of the profile.
[[nodiscard]] inline double GateRange_m(const FogProfile& profile, std::size_t gate) {
  return (static_cast<double>(profile.first_gate + gate) + 0.5) * profile.gate_m;
}
inline constexpr std::size_t kMostFogGates = 128;

/// The noise of a gate as a sum of independent standard normal deviates, of which every gate has
/// one: its own and those of its two neighbours.
struct FogNoiseWeights {
  double own{}, beside{};
};

/// The weights of the receiver's noise in gates `gate_m` apart, with variance 1: white noise that
/// the receiver answers as it answers a point, with the pulse p, so that the correlation over a
/// range x is exp(-x^2 / 4 s^2). Half a pulse length apart, neighbours correlate by 1 / sqrt(2) and
/// the next but one by 1 / 4, which weights of 1 / sqrt(2) and 1 / 2 give exactly; beyond, 0 stands
/// for 0.04 and less.
[[nodiscard]] FogNoiseWeights FogNoiseOf(const BeamSpec& beam, double gate_m);

/// The gates up to the farthest at which the densest patch reaches kLeastFogRatio.
[[nodiscard]] FogProfile FogProfileOf(const DetectorSpec& spec);

}  // namespace railcast
