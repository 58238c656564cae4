// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_EXTINCTION_H_
#define RAILCAST_DETECT_EXTINCTION_H_

#include "core/detect/base/detect_tile.h"
#include "core/detect/base/vector_math.h"

namespace railcast::RAILCAST_ISA {

/// Effect `extinction`: two-way loss in the air, power x exp(-2 alpha R). The coefficient alpha is
/// the sum for fog, rain and snow (core/detect/base/weather_optics.h).
inline void ApplyExtinction(DetectTile& tile, float extinction_per_m) {
  const float both_ways_per_m = 2.0F * extinction_per_m;
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    tile.power_ratio[i] *= Exp(-both_ways_per_m * tile.true_range_m[i]);
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_EXTINCTION_H_
