// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_SENSOR_DROPOUT_H_
#define RAILCAST_DETECT_SENSOR_DROPOUT_H_

#include "core/detect/detect_tile.h"
#include "core/detect/lane_random.h"
#include "railcast/outcome.h"

namespace railcast {

struct SensorDropoutParameters {
  std::uint64_t seed{};
  float probability{};
};

}  // namespace railcast

namespace railcast::RAILCAST_ISA {

/// Effect `sensor_dropout`: the sensor loses pulses at random, whatever they would have met.
///
///   P(lost) = dropout_probability, independently for each firing
///
/// Real sensors miss a share of the pulses that should return; docs/physics.md 1.3 gives figures.
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
