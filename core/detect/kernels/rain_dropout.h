// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_RAIN_DROPOUT_H_
#define RAILCAST_DETECT_RAIN_DROPOUT_H_

#include "core/detect/base/detect_tile.h"
#include "core/detect/base/lane_random.h"
#include "railcast/outcome.h"

namespace railcast {

struct RainParameters {
  std::uint64_t seed{};
  float dropout_per_m{};  ///< k * RR^e
};

}  // namespace railcast

namespace railcast::RAILCAST_ISA {

/// Effect `rain`: echoes are lost on the way, the more the longer the path and the higher the rain
/// rate.
///
///   P(lost) = 1 - exp(-k * RR^e * R),  k = rain_dropout_per_m, e = rain_dropout_exponent
///
/// with RR the rain rate in mm/h and R the true range in m. The publication describes the effect
/// only in words. The formula is that of a path through independent drops. The defaults
/// k = 3.65e-4 /m and e = 0.63 give the extinction of Marshall-Palmer rain (docs/physics.md 4.1),
/// so that the dropout probability equals the share of light that is lost one way.
inline void ApplyRainDropout(DetectTile& tile, const RainParameters& parameters) {
  const LaneKey key{parameters.seed, RandomUse::kRain, tile.frame};
  const float rate_per_m = parameters.dropout_per_m;
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float survival = Exp(-rate_per_m * tile.true_range_m[i]);
    const float u = LaneUnit(LaneWords(key, tile.firing[i], 0).a);
    const bool lost =
        tile.outcome[i] == static_cast<std::uint32_t>(Outcome::kReturned) && u >= survival;
    tile.outcome[i] = lost ? static_cast<std::uint32_t>(Outcome::kRainAbsorbed) : tile.outcome[i];
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_RAIN_DROPOUT_H_
