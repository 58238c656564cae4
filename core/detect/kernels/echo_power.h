// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_ECHO_POWER_H_
#define RAILCAST_DETECT_ECHO_POWER_H_

#include <cmath>

#include "core/detect/base/detect_tile.h"
#include "core/detect/base/lane_random.h"
#include "core/detect/base/vector_math.h"
#include "railcast/outcome.h"

namespace railcast {

struct SaturationParameters {
  float power_ratio{};  ///< At which the receiver saturates.
  float pulse_sigma_m{};
};

struct SunlightParameters {
  float background_gain{};  ///< Raises the threshold by sqrt(1 + gain x background reflectance).
};

struct DetectionParameters {
  std::uint64_t seed{};
  float snr_at_threshold{};
};

struct SensorDropoutParameters {
  std::uint64_t seed{};
  float probability{};
  float per_m{};  ///< Growth with the range of the surface.
  float dark_probability{};
  float inverse_dark_intensity{};
};

}  // namespace railcast

namespace railcast::RAILCAST_ISA {

/// Effect `extinction`: two-way loss in the air, power x exp(-2 alpha R). The coefficient alpha is
/// the sum for fog, rain and snow (core/detect/base/weather_optics.h).
inline void ApplyExtinction(DetectTile& tile, float extinction_per_m) {
  const float both_ways_per_m = 2.0F * extinction_per_m;
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    tile.power_ratio[i] *= Exp(-both_ways_per_m * tile.true_range_m[i]);
  }
}

/// Effect `cover`, before detection: every echo, also one from the air, loses the light that the
/// spots on the window keep back (cover.h).
inline void ApplyCoverLoss(DetectTile& tile) {
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float ratio = tile.power_ratio[i];
    tile.bare_ratio[i] = ratio;
    tile.power_ratio[i] = ratio * tile.cover[i];
  }
}

/// Effect `cover`, after detection: an echo that is too weak, but would not be behind a clean
/// window, is lost to the window.
inline void BlameCover(DetectTile& tile) {
  constexpr auto kBelowThreshold = static_cast<std::uint32_t>(Outcome::kBelowThreshold);
  constexpr auto kCoverBlocked = static_cast<std::uint32_t>(Outcome::kCoverBlocked);
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const std::uint32_t before = tile.outcome[i];
    const bool is_to_blame =
        (before == kBelowThreshold) & (tile.cover[i] < 1.0F) & (tile.bare_ratio[i] >= 1.0F);
    tile.outcome[i] = is_to_blame ? kCoverBlocked : before;
  }
}

/// Effect `range_walk`: a receiver that stops its clock when the leading edge of the pulse crosses
/// the threshold measures weak echoes too far.
///
///   error = range_walk / power ratio, at most range_walk
///
/// An edge that rises linearly over the length L crosses the threshold at L / power ratio. Ranges
/// are calibrated on strong echoes, whose error is 0; what a sensor corrects by the echo's strength
/// is not in range_walk, which is 0 by default. Echoes that only noise lifts above the threshold
/// have the error of the threshold.
inline void ApplyRangeWalk(DetectTile& tile, float range_walk_m) {
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float ratio = tile.power_ratio[i];
    tile.peak_shift_m[i] += range_walk_m / (ratio > 1.0F ? ratio : 1.0F);
  }
}

/// Effect `saturation`: a receiver whose amplitude ends at a power ratio c.
///
///   power ratio = min(p, c),   half length above the threshold = s sqrt(2 ln p)
///
/// A Gaussian pulse of peak p and standard deviation s is above the threshold, 1, over twice that
/// length. A clipped pulse has no peak, so that a receiver can only time its edges: what is above
/// the threshold without a gap is one echo where part of it is clipped (ReturnsOf(),
/// core/simulate/returns.h). Range errors follow from the power as clipped; range_walk from the
/// power that arrives.
///
/// Validity: pulses that oblique surfaces have stretched count with the length of the pulse itself.
/// How a receiver recovers after an overload is not modelled.
inline void ApplySaturation(DetectTile& tile, const SaturationParameters& parameters) {
  const SaturationParameters p = parameters;  // The copy cannot alias the tile.
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float ratio = tile.power_ratio[i];
    // Both comparisons are false where there is no echo: its power is NaN.
    const float above = ratio > 1.0F ? ratio : 1.0F;
    tile.busy_m[i] = p.pulse_sigma_m * std::sqrt(2.0F * Log(above));
    tile.power_ratio[i] = ratio > p.power_ratio ? p.power_ratio : ratio;
  }
}

/// The part of effect `sunlight` that concerns every beam: shot noise of the sunlight on the
/// surfaces that the beam meets raises the threshold by sqrt(1 + B rho / B0), rho being the sum of
/// their shares x reflectances; SunBackgroundGain() (weather_optics.h) gives B / B0.
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

/// Effect `sensor_dropout`: the sensor loses pulses at random.
///
///   P(lost) = 1 - (1 - dropout_probability) exp(-dropout_per_m R) (1 - dark),
///   dark    = dark_dropout_probability exp(-I / dark_dropout_intensity)
///
/// independently for each firing. R is the true range of the surface, 0 where there is none. I is
/// the brightness of the surface: the intensity of the echo over the share of the beam that meets
/// it. `dark` is 0 where there is no surface or no intensity is computed. All echoes of a firing
/// share one draw, so that at equal brightness a loss of the nearer echo is a loss of the farther
/// one, too. Real sensors lose more on dark surfaces; docs/results/validation.md gives figures.
inline void ApplySensorDropout(DetectTile& tile, const SensorDropoutParameters& parameters) {
  const LaneKey key{parameters.seed, RandomUse::kSensorDropout, tile.frame};
  const SensorDropoutParameters p = parameters;  // The copy cannot alias the tile.
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float u = LaneUnit(LaneWords(key, tile.firing[i], 0).a);
    const float true_range_m = tile.true_range_m[i];
    const float range_m = true_range_m > 0.0F ? true_range_m : 0.0F;  // NaN gives 0, too.
    const float anywhere =
        p.probability + (1.0F - p.probability) * (1.0F - Exp(-p.per_m * range_m));
    const float brightness = tile.intensity[i] / tile.share[i];  // NaN of echoes from the air.
    const bool is_seen = true_range_m > 0.0F && brightness >= 0.0F;
    const float dark =
        is_seen ? p.dark_probability * Exp(-p.inverse_dark_intensity * brightness) : 0.0F;
    const float lost = anywhere + (1.0F - anywhere) * dark;
    tile.outcome[i] =
        u < lost ? static_cast<std::uint32_t>(Outcome::kSensorDropout) : tile.outcome[i];
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_ECHO_POWER_H_
