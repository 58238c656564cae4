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

/// Peaks that earlier climbs have found, which a further climb need not reach again.
struct WaveKnown {
  const WavePeak* peaks{};
  std::size_t num_peaks{};
  /// A climb that heads towards a known peak within this distance ends there, because no valley can
  /// lie between.
  float reach_m{};
};

}  // namespace railcast
