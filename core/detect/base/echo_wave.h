#pragma once

#include <cstddef>

namespace railcast {

/// Number of components of a wave that are summed at a time.
inline constexpr std::size_t kWaveLanes = 16;

/// The received waveform of one beam as a sum of Gaussians over range:
/// w(r) = sum_i peak_i exp(-(r - range_i)^2 / 2 variance_i).
struct EchoWave {
  std::size_t size{};  ///< A multiple of kWaveLanes; padding has peak 0.
  const float* range_m{};
  const float* peak{};                     ///< In multiples of the least detectable power.
  const float* inverse_variance_per_m2{};  ///< 1 / (pulse variance + spread variance).
};

/// A maximum of the waveform w(r).
struct WavePeak {
  float range_m{};
  float value{};
};

/// Number of climbs to maxima that go side by side.
inline constexpr std::size_t kClimbLanes = 8;

/// Climbs on waves, a lane each. Values of components are those of the first component of all
/// lanes, then those of the second, and so on; where a wave has fewer, peak is 0.
struct WaveClimbs {
  std::size_t num_components{};
  const float* range_m{};
  const float* peak{};
  const float* inverse_variance_per_m2{};
  float from_m[kClimbLanes]{};
};

}  // namespace railcast
