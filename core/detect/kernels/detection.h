// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_DETECTION_H_
#define RAILCAST_DETECT_DETECTION_H_

#include <cmath>

#include "core/detect/base/detect_tile.h"
#include "core/detect/base/lane_random.h"
#include "core/detect/base/vector_math.h"
#include "railcast/outcome.h"

namespace railcast {

struct SunlightParameters {
  float background_gain{};  ///< Raises the threshold by sqrt(1 + gain x background reflectance).
};

struct DetectionParameters {
  std::uint64_t seed{};
  float snr_at_threshold{};
};

}  // namespace railcast

namespace railcast::RAILCAST_ISA {

/// The part of effect `sunlight` that concerns every beam: shot noise of the sunlight on the
/// surface that the beam meets raises the threshold by sqrt(1 + B rho / B0); SunBackgroundGain()
/// (weather_optics.h) gives B / B0.
inline void ApplySunlight(DetectTile& tile, const SunlightParameters& parameters) {
  const float gain = parameters.background_gain;
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    tile.power_ratio[i] /= std::sqrt(1.0F + gain * tile.reflectivity[i]);
  }
}

/// Effect `detection`: the outcome becomes below_threshold where the power ratio is less than 1.
/// With effect `detection_probability` the transition is gradual, since Gaussian noise is added to
/// the amplitude:
///
///   P(detected) = Phi(SNR - SNR_t),  SNR = SNR_t x power ratio
///
/// The power ratio of fog's echoes contains the noise by which they were found, so that nothing is
/// left to draw.
template <bool kIsSmooth>
inline void ApplyDetection(DetectTile& tile, const DetectionParameters& parameters) {
  const LaneKey key{parameters.seed, RandomUse::kDetection, tile.frame};
  const DetectionParameters p = parameters;  // The copy cannot alias the tile.
  constexpr auto kReturned = static_cast<std::uint32_t>(Outcome::kReturned);
  constexpr auto kClutter = static_cast<std::uint32_t>(Outcome::kClutter);
  constexpr auto kBelowThreshold = static_cast<std::uint32_t>(Outcome::kBelowThreshold);
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float ratio = tile.power_ratio[i];
    // NaN fails the comparison, so that an echo without a power is not detected.
    bool detected = ratio >= 1.0F;
    if constexpr (kIsSmooth) {
      const float u = LaneUnit(LaneWords(key, tile.firing[i], tile.echo[i]).a);
      // Beyond 9 sigma, Phi rounds to 1 in float32.
      const float excess = p.snr_at_threshold * (ratio - 1.0F);
      const bool is_fog = tile.echo[i] - kFirstFogEcho < kNumFogEchoes;
      detected = is_fog ? detected : u < NormalCdf(excess > 9.0F ? 9.0F : excess);
    }
    const std::uint32_t before = tile.outcome[i];
    const bool answers = (before == kReturned) | (before == kClutter);
    tile.outcome[i] = (answers & !detected) ? kBelowThreshold : before;
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_DETECTION_H_
