// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_SATURATION_H_
#define RAILCAST_DETECT_SATURATION_H_

#include <cmath>

#include "core/detect/base/detect_tile.h"
#include "core/detect/base/vector_math.h"

namespace railcast {

struct SaturationParameters {
  float power_ratio{};  ///< At which the receiver saturates.
  float pulse_sigma_m{};
};

}  // namespace railcast

namespace railcast::RAILCAST_ISA {

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

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_SATURATION_H_
