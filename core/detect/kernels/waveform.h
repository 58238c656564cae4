// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_WAVEFORM_H_
#define RAILCAST_DETECT_WAVEFORM_H_

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/detect/base/effect_parameters.h"
#include "core/detect/base/vector_math.h"

namespace railcast::RAILCAST_ISA {

/// e to this power is 1e-26. Parts of a wave that are farther away add less than the rounding of
/// the sum, and as denormal numbers cost much time.
constexpr float kLeastExponent = -60.0F;

/// Sums over the components of each climb's wave, which give its value and derivatives at a range.
struct WaveSums {
  alignas(64) float value[kClimbLanes];   ///< w(r)
  alignas(64) float weight[kClimbLanes];  ///< sum of w_i / variance_i
  alignas(64) float moment[kClimbLanes];  ///< sum of w_i / variance_i x (r_i - r) = w'(r)
  /// sum of w_i / variance_i^2 x (r_i - r)^2; w''(r) = bend - weight
  alignas(64) float bend[kClimbLanes];
};

inline void SumWaves(const WaveClimbs& climbs, const float* range_m, WaveSums& sums) {
  alignas(64) float at_m[kClimbLanes];
  alignas(64) float value[kClimbLanes] = {};
  alignas(64) float weight[kClimbLanes] = {};
  alignas(64) float moment[kClimbLanes] = {};
  alignas(64) float bend[kClimbLanes] = {};
  for (std::size_t k = 0; k < kClimbLanes; ++k) at_m[k] = range_m[k];
  for (std::size_t i = 0; i < climbs.num_components; ++i) {
    const float* const r = climbs.range_m + i * kClimbLanes;
    const float* const peak = climbs.peak + i * kClimbLanes;
    const float* const inverse = climbs.inverse_variance_per_m2 + i * kClimbLanes;
#ifndef __clang__
#pragma GCC ivdep
#endif
    for (std::size_t k = 0; k < kClimbLanes; ++k) {
      const float ahead_m = r[k] - at_m[k];
      const float exponent = -0.5F * ahead_m * ahead_m * inverse[k];
      const float least = exponent < kLeastExponent ? kLeastExponent : exponent;
      const float near = peak[k] * Exp(least);
      const float part = exponent < kLeastExponent ? 0.0F : near;
      const float slope = part * inverse[k] * ahead_m;
      value[k] += part;
      weight[k] += part * inverse[k];
      moment[k] += slope;
      bend[k] += slope * inverse[k] * ahead_m;
    }
  }
  for (std::size_t k = 0; k < kClimbLanes; ++k) {
    sums.value[k] = value[k];
    sums.weight[k] = weight[k];
    sums.moment[k] = moment[k];
    sums.bend[k] = bend[k];
  }
}

/// Where climbs stand.
struct ClimbState {
  alignas(64) float range_m[kClimbLanes];
  alignas(64) float value[kClimbLanes];      ///< The wave's value there.
  alignas(64) float longest_m[kClimbLanes];  ///< The longest step allowed.
  alignas(64) float shift_m[kClimbLanes];    ///< The last step.
  alignas(64) float goes_on[kClimbLanes];    ///< 1, or 0 if it has arrived.
};

/// Makes a step of all climbs: Newton's where w is sufficiently concave, else a mean shift, to the
/// mean of r_i weighted by w_i / variance_i, which never overshoots a maximum (Comaniciu and Meer
/// 2002). On a wave much wider than its components, such as that of grazed ground, mean shifts are
/// too short to arrive; there a step is Newton's or one sigma of the components, whichever is
/// shorter. Returns whether any climb goes on. Inlined, GCC 12 would not vectorise it.
[[nodiscard, gnu::noinline]] inline bool StepAll(const WaveSums& sums, ClimbState& climb) {
  // A Newton step is accepted up to this many times the mean shift, which is always too short.
  constexpr float kTrust = 4.0F;
  // A Newton step squares the error: after a step shorter than this, less than 0.1 mm remains.
  constexpr float kStill_m = 3e-3F;
#ifndef __clang__
#pragma GCC ivdep
#endif
  for (std::size_t k = 0; k < kClimbLanes; ++k) {
    const float weight = sums.weight[k];
    const float moment = sums.moment[k];
    const float longest_m = climb.longest_m[k];
    const float mean_shift_m = moment / weight;
    const float bend_down = weight - sums.bend[k];
    const float sigma_m = std::sqrt(sums.value[k] / weight);
    // 1 or 0, since GCC 12 does not vectorise what combines truth values.
    const float is_near = bend_down * sigma_m > std::fabs(moment) ? 1.0F : 0.0F;
    const float is_wide = std::fabs(mean_shift_m) < 0.5F * sigma_m ? 1.0F : 0.0F;
    const float is_newton = bend_down * kTrust > weight ? 1.0F : is_wide * is_near;
    const float one_sigma_m = std::copysign(sigma_m, moment);
    const float slow_m = is_wide > 0.0F ? one_sigma_m : mean_shift_m;
    const float newton_m = moment / bend_down;
    const float wanted_m = is_newton > 0.0F ? newton_m : slow_m;
    const float limit_m = std::copysign(longest_m, wanted_m);
    const float is_short = std::fabs(wanted_m) <= longest_m ? is_newton : 0.0F;
    const float shift_m = std::fabs(wanted_m) <= longest_m ? wanted_m : limit_m;
    const float is_still = std::fabs(shift_m) < kStill_m ? is_short : 0.0F;
    const float rise = 0.5F * moment * shift_m;
    const float going = weight > 0.0F ? climb.goes_on[k] : 0.0F;
    const float risen = is_still > 0.0F ? sums.value[k] + rise : sums.value[k];
    const float old_value = climb.value[k];
    climb.value[k] = climb.goes_on[k] > 0.0F ? risen : old_value;
    const float next_m = climb.range_m[k] + shift_m;
    const float range_m = climb.range_m[k];
    climb.range_m[k] = going > 0.0F ? next_m : range_m;
    climb.shift_m[k] = shift_m;
    climb.goes_on[k] = is_still > 0.0F ? 0.0F : going;
  }
  float num_going = 0.0F;
  for (const float goes_on : climb.goes_on) num_going += goes_on;
  return num_going > 0.0F;
}

/// Climbs to maxima of w(r) = sum peak_i exp(-(r - r_i)^2 / 2 variance_i), all side by side. A step
/// that jumps over a maximum halves the longest one allowed. A climb ends where its wave is 0.
inline void ClimbWaves(const WaveClimbs& climbs, WavePeak* peaks) {
  constexpr int kMaxSteps = 40;
  constexpr float kUnlimited_m = 1e9F;
  ClimbState climb;
  for (std::size_t k = 0; k < kClimbLanes; ++k) {
    climb.range_m[k] = climbs.from_m[k];
    climb.value[k] = 0.0F;
    climb.longest_m[k] = kUnlimited_m;
    climb.goes_on[k] = 1.0F;
  }
  WaveSums sums;
  SumWaves(climbs, climb.range_m, sums);
  for (int step = 0; step < kMaxSteps && StepAll(sums, climb); ++step) {
    SumWaves(climbs, climb.range_m, sums);
    for (std::size_t k = 0; k < kClimbLanes; ++k) {
      // A maximum lies between here and the last place: from now on steps close in on it.
      const bool is_past = climb.shift_m[k] * sums.moment[k] < 0.0F;
      const float half_m = 0.5F * std::fabs(climb.shift_m[k]);
      climb.longest_m[k] = is_past ? half_m : climb.longest_m[k];
    }
  }
  for (std::size_t k = 0; k < kClimbLanes; ++k) {
    peaks[k] = {climb.range_m[k], climb.goes_on[k] > 0.0F ? sums.value[k] : climb.value[k]};
  }
}

/// How far from a sample components of a wave may be that add anything to it.
[[nodiscard]] inline float ReachOf(const EchoWave& wave) {
  float least = wave.inverse_variance_per_m2[0];
  for (std::size_t i = 1; i < wave.size; ++i) {
    least = std::fmin(least, wave.inverse_variance_per_m2[i]);
  }
  // A little more, so that rounding does not matter.
  return 1.001F * std::sqrt(-2.0F * kLeastExponent / least);
}

/// Samples w(r) at equal steps, of an eighth of a component's standard deviation at most. From one
/// step to the next, a component falls by a factor that itself falls by a constant one:
/// exponentials are needed every kStride samples only, and rounding adds up to kStride^2 / 2 x 6e-8
/// in between. kWaveLanes components, which are sorted by range, are summed at a time; the order of
/// additions is fixed, so that all instruction sets give the same bits. Those out of reach would
/// add 0.
inline void SampleWave(
    const EchoWave& wave, float first_m, float step_m, std::size_t num_samples, float* samples) {
  constexpr std::size_t kStride = 16;
  const float reach_m = ReachOf(wave);
  std::size_t near = 0;
  for (std::size_t begin = 0; begin < num_samples; begin += kStride) {
    const float begin_m = first_m + step_m * static_cast<float>(begin);
    const float far_m = begin_m + step_m * static_cast<float>(kStride) + reach_m;
    // The last ones are filled up with components of no power.
    while (near + kWaveLanes < wave.size &&
           wave.range_m[near + kWaveLanes - 1] < begin_m - reach_m) {
      near += kWaveLanes;
    }
    alignas(64) float values[kStride][kWaveLanes] = {};
    for (std::size_t first = near; first < wave.size && wave.range_m[first] <= far_m;
         first += kWaveLanes) {
      alignas(64) float part[kWaveLanes];
      alignas(64) float fall[kWaveLanes];
      alignas(64) float bend[kWaveLanes];
#ifndef __clang__
#pragma GCC ivdep
#endif
      for (std::size_t i = 0; i < kWaveLanes; ++i) {
        const float ahead_m = wave.range_m[first + i] - begin_m;
        const float scale = 0.5F * wave.inverse_variance_per_m2[first + i];
        const float exponent = -scale * ahead_m * ahead_m;
        const float least = exponent < kLeastExponent ? kLeastExponent : exponent;
        const float full = wave.peak[first + i] * Exp(least);
        part[i] = exponent < kLeastExponent ? 0.0F : full;
        // Where it is steeper, the part is 0.
        const float slope = scale * step_m * (2.0F * ahead_m - step_m);
        const float falling = slope < kLeastExponent ? kLeastExponent : slope;
        fall[i] = Exp(falling > -kLeastExponent ? -kLeastExponent : falling);
        bend[i] = Exp(-2.0F * scale * step_m * step_m);
      }
      for (std::size_t k = 0; k < kStride; ++k) {
        for (std::size_t i = 0; i < kWaveLanes; ++i) {
          values[k][i] += part[i];
          part[i] *= fall[i];
          fall[i] *= bend[i];
        }
      }
    }
    const std::size_t size = num_samples - begin < kStride ? num_samples - begin : kStride;
    for (std::size_t k = 0; k < size; ++k) {
      // Pairwise summation has shorter chains of dependent additions than sequential summation.
      float* const value = values[k];
      for (std::size_t half = kWaveLanes / 2; half > 0; half /= 2) {
        for (std::size_t i = 0; i < half; ++i) value[i] += value[i + half];
      }
      samples[begin + k] = value[0];
    }
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_WAVEFORM_H_
