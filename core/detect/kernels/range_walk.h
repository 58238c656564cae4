// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_RANGE_WALK_H_
#define RAILCAST_DETECT_RANGE_WALK_H_

#include "core/detect/base/detect_tile.h"

namespace railcast::RAILCAST_ISA {

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

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_RANGE_WALK_H_
