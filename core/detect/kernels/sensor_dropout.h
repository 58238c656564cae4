// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_SENSOR_DROPOUT_H_
#define RAILCAST_DETECT_SENSOR_DROPOUT_H_

#include "core/detect/base/detect_tile.h"
#include "core/detect/base/lane_random.h"
#include "core/detect/base/vector_math.h"
#include "railcast/outcome.h"

namespace railcast {

struct SensorDropoutParameters {
  std::uint64_t seed{};
  float probability{};
  float per_m{};  ///< Growth with the range of the surface.
  float dark_probability{};
  float inverse_dark_intensity{};
};

}  // namespace railcast

namespace railcast::RAILCAST_ISA {

/// Effect `sensor_dropout`: the sensor loses pulses at random.
///
///   P(lost) = 1 - (1 - dropout_probability) exp(-dropout_per_m R) (1 - dark),
///   dark    = dark_dropout_probability exp(-I / dark_dropout_intensity)
///
/// independently for each firing. R is the true range of the surface, 0 where there is none. I is
/// the brightness of the surface: the intensity of the echo over the share of the beam that meets
/// it. `dark` is 0 where there is no surface or no intensity is computed. All echoes of a firing
/// share one draw, so that at equal brightness a loss of the nearer echo is a loss of the farther
/// one, too. Real sensors lose more on dark surfaces; docs/validation.md gives figures.
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

#endif  // RAILCAST_DETECT_SENSOR_DROPOUT_H_
