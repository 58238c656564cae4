// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_RAIN_DROPOUT_H_
#define RAILCAST_DETECT_RAIN_DROPOUT_H_

#include "core/detect/detect_tile.h"
#include "core/detect/effect_parameters.h"
#include "core/detect/lane_random.h"
#include "core/frame/outcome.h"

namespace railcast::RAILCAST_ISA {

/// Effect `rain`: echoes lost on the way, more with path length and rain rate.
///
///   P(lost) = 1 - exp(-k * RR^e * R),  k = rain_dropout_per_m, e = rain_dropout_exponent
///
/// The publication has words only. The form is that of a path through independent drops; the
/// defaults k = 3.65e-4 /m, e = 0.63 are the extinction of Marshall-Palmer rain (physics.md 4.1),
/// so that the dropout equals the share of light that one passage of the path loses. RR in mm/h.
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
