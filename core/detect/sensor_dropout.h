// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_SENSOR_DROPOUT_H_
#define RAILCAST_DETECT_SENSOR_DROPOUT_H_

#include "core/detect/detect_tile.h"
#include "core/detect/effect_parameters.h"
#include "core/detect/lane_random.h"
#include "core/frame/outcome.h"

namespace railcast::RAILCAST_ISA {

/// Effect `sensor_dropout`: pulses that the sensor misses, whatever they would have met.
///
///   P(missed) = dropout_probability, independent of everything
///
/// Real sensors miss a share of the pulses that should return (physics.md 1.3, last lines).
inline void ApplySensorDropout(DetectTile& tile, const SensorDropoutParameters& parameters) {
  const LaneKey key{parameters.seed, RandomUse::kSensorDropout, tile.frame};
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float u = LaneUnit(LaneWords(key, tile.firing[i], 0).a);
    tile.outcome[i] = u < parameters.probability
                          ? static_cast<std::uint32_t>(Outcome::kSensorDropout)
                          : tile.outcome[i];
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_SENSOR_DROPOUT_H_
