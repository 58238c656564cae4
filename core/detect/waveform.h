// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_WAVEFORM_H_
#define RAILCAST_DETECT_WAVEFORM_H_

#include <cstddef>

#include "core/detect/echo_wave.h"
#include "core/detect/vector_math.h"

namespace railcast::RAILCAST_ISA {

/// Sums over a wave's components, kWaveLanes at a time; the order of additions is fixed, so that
/// every instruction set gives the same bits.
struct WaveSums {
  float value;   ///< w(r)
  float weight;  ///< sum of w_i / variance_i
  float moment;  ///< sum of w_i / variance_i x (r_i - r)
};

[[nodiscard]] inline WaveSums SumWave(const EchoWave& wave, float range_m) {
  float value[kWaveLanes] = {};
  float weight[kWaveLanes] = {};
  float moment[kWaveLanes] = {};
  for (std::size_t first = 0; first < wave.size; first += kWaveLanes) {
    const float* r = wave.range_m + first;
    const float* peak = wave.peak + first;
    const float* inverse = wave.inverse_variance_per_m2 + first;
    for (std::size_t i = 0; i < kWaveLanes; ++i) {
      const float ahead_m = r[i] - range_m;
      const float part = peak[i] * Exp(-0.5F * ahead_m * ahead_m * inverse[i]);
      value[i] += part;
      weight[i] += part * inverse[i];
      moment[i] += part * inverse[i] * ahead_m;
    }
  }
  WaveSums sums{};
  for (std::size_t i = 0; i < kWaveLanes; ++i) {
    sums.value += value[i];
    sums.weight += weight[i];
    sums.moment += moment[i];
  }
  return sums;
}

/// Climbs to the nearest maximum of w(r) = sum peak_i exp(-(r - r_i)^2 / 2 variance_i) by mean
/// shift: the derivative vanishes where r is the mean of r_i weighted by w_i / variance_i, and the
/// step to that mean never overshoots a maximum (Comaniciu and Meer 2002).
[[nodiscard]] inline WavePeak ClimbWave(const EchoWave& wave, float from_m) {
  constexpr int kMaxSteps = 40;
  constexpr float kStill_m = 1e-4F;
  float range_m = from_m;
  WaveSums sums = SumWave(wave, range_m);
  for (int step = 0; step < kMaxSteps && sums.weight > 0.0F; ++step) {
    const float shift_m = sums.moment / sums.weight;
    range_m += shift_m;
    sums = SumWave(wave, range_m);
    if (shift_m < kStill_m && shift_m > -kStill_m) break;
  }
  return {range_m, sums.value};
}

/// w(r) at equal steps.
inline void SampleWave(
    const EchoWave& wave, float first_m, float step_m, std::size_t num_samples, float* samples) {
  for (std::size_t k = 0; k < num_samples; ++k) {
    samples[k] = SumWave(wave, first_m + step_m * static_cast<float>(k)).value;
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_WAVEFORM_H_
