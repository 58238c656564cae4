// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_DETECTION_H_
#define RAILCAST_DETECT_DETECTION_H_

#include <cmath>

#include "core/detect/detect_tile.h"
#include "core/detect/effect_parameters.h"
#include "core/detect/lane_random.h"
#include "core/detect/vector_math.h"
#include "core/frame/outcome.h"

namespace railcast::RAILCAST_ISA {

/// Effect `sunlight`, its part in every beam: shot noise of the sun's light on what the beam looks
/// at raises the threshold by sqrt(1 + B rho / B0); see weather_optics.h for B0.
inline void ApplySunlight(DetectTile& tile, const SunlightParameters& parameters) {
  const float gain = parameters.background_gain;
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    tile.power_ratio[i] /= std::sqrt(1.0F + gain * tile.reflectivity[i]);
  }
}

/// Effect `detection`: below_threshold where the power ratio is less than 1. With effect
/// `detection_probability` the edge is soft: noise of the amplitude's own size decides,
///
///   P(detected) = Phi(SNR - SNR_t),  SNR = SNR_t x power ratio
template <bool kIsSmooth>
inline void ApplyDetection(DetectTile& tile, const DetectionParameters& parameters) {
  const LaneKey key{parameters.seed, RandomUse::kDetection, tile.frame};
  const DetectionParameters p = parameters;  // A copy: no store to the tile can change it.
  constexpr auto kReturned = static_cast<std::uint32_t>(Outcome::kReturned);
  constexpr auto kClutter = static_cast<std::uint32_t>(Outcome::kClutter);
  constexpr auto kBelowThreshold = static_cast<std::uint32_t>(Outcome::kBelowThreshold);
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float ratio = tile.power_ratio[i];
    // NaN is not detected.
    bool detected = ratio >= 1.0F;
    if constexpr (kIsSmooth) {
      const float u = LaneUnit(LaneWords(key, tile.firing[i], tile.echo[i]).a);
      // Beyond 9 sigma Phi is 1 to float32.
      const float excess = p.snr_at_threshold * (ratio - 1.0F);
      detected = u < NormalCdf(excess > 9.0F ? 9.0F : excess);
    }
    const std::uint32_t before = tile.outcome[i];
    const bool answers = (before == kReturned) | (before == kClutter);
    tile.outcome[i] = (answers & !detected) ? kBelowThreshold : before;
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_DETECTION_H_
