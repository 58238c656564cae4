// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_THRESHOLD_H_
#define RAILCAST_DETECT_THRESHOLD_H_

#include "core/detect/base/detect_tile.h"
#include "core/detect/base/vector_math.h"
#include "railcast/outcome.h"

namespace railcast {

struct ThresholdParameters {
  float inverse_threshold_m2{};  ///< reference_range^2 / reference_threshold
  float fog_density_per_m{};
};

}  // namespace railcast

namespace railcast::RAILCAST_ISA {

/// Effect `threshold`: decides whether the echo of the surface is strong enough.
///
///   intensity = reflectivity * cos(incidence)
///   received  = intensity * exp(-fog_density * R)              (one way, as published)
///   threshold = reference_threshold * (R / reference_range)^2
///   power_ratio = received / threshold;  below_threshold where it is < 1
///
/// Source: the published plausibility model (Vir2Rail, module 4). The physical loss is
/// exp(-2 alpha R); to get it, set the fog density to twice the extinction coefficient. R is the
/// true range in metres.
inline void ApplyThreshold(DetectTile& tile, const ThresholdParameters& parameters) {
  const float scale = parameters.inverse_threshold_m2;
  const float fog_per_m = parameters.fog_density_per_m;
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float range_m = tile.true_range_m[i];
    const float intensity = tile.reflectivity[i] * tile.cos_incidence[i];
    const float received = intensity * Exp(-fog_per_m * range_m);
    const float ratio = received * scale / (range_m * range_m);
    const bool lost =
        tile.outcome[i] == static_cast<std::uint32_t>(Outcome::kReturned) && !(ratio >= 1.0F);
    tile.intensity[i] = intensity;
    tile.power_ratio[i] = ratio;
    tile.outcome[i] = lost ? static_cast<std::uint32_t>(Outcome::kBelowThreshold) : tile.outcome[i];
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_THRESHOLD_H_
