// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_SENSOR_DROPOUT_H_
#define RAILCAST_DETECT_SENSOR_DROPOUT_H_

#include "core/detect/detect_tile.h"
#include "core/detect/lane_random.h"
#include "core/detect/vector_math.h"
#include "railcast/outcome.h"

namespace railcast {

struct SensorDropoutParameters {
  std::uint64_t seed{};
  float probability{};
  float per_m{};  ///< Growth with the range of the surface.
};

}  // namespace railcast

namespace railcast::RAILCAST_ISA {

/// Effect `sensor_dropout`: the sensor loses pulses at random, whatever they would have met.
///
///   P(lost) = 1 - (1 - dropout_probability) exp(-dropout_per_m R), independently for each firing
///
/// R is the true range of the surface, 0 where there is none. All echoes of a firing share one
/// draw, so that a loss of the nearer echo is a loss of the farther one, too. Real sensors miss a
/// share of the pulses that should return, and more of them the farther they look; docs/physics.md
/// 1.3 gives figures.
inline void ApplySensorDropout(DetectTile& tile, const SensorDropoutParameters& parameters) {
  const LaneKey key{parameters.seed, RandomUse::kSensorDropout, tile.frame};
  const SensorDropoutParameters p = parameters;  // The copy cannot alias the tile.
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float u = LaneUnit(LaneWords(key, tile.firing[i], 0).a);
    const float true_range_m = tile.true_range_m[i];
    const float range_m = true_range_m > 0.0F ? true_range_m : 0.0F;  // NaN gives 0, too.
    const float lost = p.probability + (1.0F - p.probability) * (1.0F - Exp(-p.per_m * range_m));
    tile.outcome[i] =
        u < lost ? static_cast<std::uint32_t>(Outcome::kSensorDropout) : tile.outcome[i];
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_SENSOR_DROPOUT_H_
