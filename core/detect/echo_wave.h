#pragma once

#include <cstddef>

namespace railcast {

/// Components of a wave are summed this many at a time.
inline constexpr std::size_t kWaveLanes = 16;

/// The light that comes back along one beam, as a sum of Gaussians over range:
/// w(r) = sum_i peak_i exp(-(r - range_i)^2 / 2 variance_i).
struct EchoWave {
  std::size_t size{};  ///< A multiple of kWaveLanes; fillers have peak 0.
  const float* range_m{};
  const float* peak{};                     ///< In multiples of the least detectable power.
  const float* inverse_variance_per_m2{};  ///< Of pulse and spread together.
};

/// A maximum of w.
struct WavePeak {
  float range_m{};
  float value{};
};

/// Where a climb need not go once more.
struct WaveKnown {
  const WavePeak* peaks{};
  std::size_t num_peaks{};
  /// A climb that heads for a known peak no farther away than this ends there: two pulses that near
  /// have no valley between them.
  float reach_m{};
};

}  // namespace railcast
