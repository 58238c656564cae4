// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_WAVEFORM_H_
#define RAILCAST_DETECT_WAVEFORM_H_

#include <cmath>
#include <cstddef>

#include "core/detect/base/echo_wave.h"
#include "core/detect/base/vector_math.h"

namespace railcast::RAILCAST_ISA {

/// Sums over the components of a wave, which give its value and derivatives. kWaveLanes components
/// are summed at a time; the order of additions is fixed, so that all instruction sets give the
/// same bits.
struct WaveSums {
  float value;   ///< w(r)
  float weight;  ///< sum of w_i / variance_i
  float moment;  ///< sum of w_i / variance_i x (r_i - r) = w'(r)
  float bend;    ///< sum of w_i / variance_i^2 x (r_i - r)^2; w''(r) = bend - weight
};

/// e to this power is 1e-26.
constexpr float kLeastExponent = -60.0F;

[[nodiscard]] inline WaveSums SumWave(const EchoWave& wave, float range_m) {
  float value[kWaveLanes] = {};
  float weight[kWaveLanes] = {};
  float moment[kWaveLanes] = {};
  float bend[kWaveLanes] = {};
  for (std::size_t first = 0; first < wave.size; first += kWaveLanes) {
    const float* r = wave.range_m + first;
    const float* peak = wave.peak + first;
    const float* inverse = wave.inverse_variance_per_m2 + first;
    for (std::size_t i = 0; i < kWaveLanes; ++i) {
      const float ahead_m = r[i] - range_m;
      const float exponent = -0.5F * ahead_m * ahead_m * inverse[i];
      // Farther parts add less than the rounding of the sum, and as denormal numbers cost much
      // time.
      const float part = exponent < kLeastExponent ? 0.0F : peak[i] * Exp(exponent);
      const float slope = part * inverse[i] * ahead_m;
      value[i] += part;
      weight[i] += part * inverse[i];
      moment[i] += slope;
      bend[i] += slope * inverse[i] * ahead_m;
    }
  }
  // Pairwise summation has shorter chains of dependent additions than sequential summation.
  for (std::size_t half = kWaveLanes / 2; half > 0; half /= 2) {
    for (std::size_t i = 0; i < half; ++i) {
      value[i] += value[i + half];
      weight[i] += weight[i + half];
      moment[i] += moment[i + half];
      bend[i] += bend[i + half];
    }
  }
  return {value[0], weight[0], moment[0], bend[0]};
}

/// Climbs to a maximum of w(r) = sum peak_i exp(-(r - r_i)^2 / 2 variance_i). A step is Newton's
/// where w is sufficiently concave, else a mean shift: to the mean of r_i weighted by
/// w_i / variance_i, which never overshoots a maximum (Comaniciu and Meer 2002). On a wave much
/// wider than its components, such as that of grazed ground, mean shifts are too short to arrive;
/// there a step is Newton's or one sigma of the components, whichever is shorter. A step that jumps
/// over a maximum halves the longest one allowed.
[[nodiscard]] inline WavePeak ClimbWave(const EchoWave& wave,
                                        float from_m,
                                        const WaveKnown& known) {
  constexpr int kMaxSteps = 40;
  // A Newton step squares the error: after a step shorter than this, less than 0.1 mm remains.
  constexpr float kStill_m = 3e-3F;
  // A Newton step is accepted up to this many times the mean shift, which is always too short.
  constexpr float kTrust = 4.0F;
  constexpr float kUnlimited_m = 1e9F;
  float range_m = from_m;
  WaveSums sums = SumWave(wave, range_m);
  for (std::size_t i = 0; i < known.num_peaks; ++i) {
    const float ahead_m = known.peaks[i].range_m - range_m;
    const bool is_near = ahead_m < known.reach_m && ahead_m > -known.reach_m;
    if (is_near && (ahead_m > 0.0F) == (sums.moment > 0.0F)) return known.peaks[i];
  }
  float longest_m = kUnlimited_m;
  for (int step = 0; step < kMaxSteps && sums.weight > 0.0F; ++step) {
    const float mean_shift_m = sums.moment / sums.weight;
    const float bend_down = sums.weight - sums.bend;
    bool is_newton = bend_down * kTrust > sums.weight;
    float shift_m = is_newton ? sums.moment / bend_down : mean_shift_m;
    if (!is_newton) {
      const float sigma_m = std::sqrt(sums.value / sums.weight);
      if (std::fabs(mean_shift_m) < 0.5F * sigma_m) {
        is_newton = bend_down * sigma_m > std::fabs(sums.moment);
        shift_m = is_newton ? sums.moment / bend_down : std::copysign(sigma_m, sums.moment);
      }
    }
    if (std::fabs(shift_m) > longest_m) {
      is_newton = false;
      shift_m = std::copysign(longest_m, shift_m);
    }
    range_m += shift_m;
    if (is_newton && shift_m < kStill_m && shift_m > -kStill_m) {
      return {range_m, sums.value + 0.5F * sums.moment * shift_m};
    }
    const bool rose = sums.moment > 0.0F;
    sums = SumWave(wave, range_m);
    // A maximum lies between here and the last place: from now on steps close in on it.
    if (rose != (sums.moment > 0.0F)) longest_m = 0.5F * std::fabs(shift_m);
  }
  return {range_m, sums.value};
}

/// Samples w(r) at equal steps.
inline void SampleWave(
    const EchoWave& wave, float first_m, float step_m, std::size_t num_samples, float* samples) {
  for (std::size_t k = 0; k < num_samples; ++k) {
    samples[k] = SumWave(wave, first_m + step_m * static_cast<float>(k)).value;
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_WAVEFORM_H_
