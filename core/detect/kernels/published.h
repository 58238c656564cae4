// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_PUBLISHED_H_
#define RAILCAST_DETECT_PUBLISHED_H_

#include "core/detect/base/detect_tile.h"
#include "core/detect/base/lane_random.h"
#include "core/detect/base/vector_math.h"
#include "railcast/outcome.h"

namespace railcast {

struct ThresholdParameters {
  float inverse_threshold_m2{};  ///< reference_range^2 / reference_threshold
  float fog_density_per_m{};
};

struct RainParameters {
  std::uint64_t seed{};
  float dropout_per_m{};  ///< k * RR^e
};

struct SnowParameters {
  std::uint64_t seed{};
  float probability{};  ///< Probability that a flake sends an echo.
  float range_scale_m{};
  float range_min_m{};
  float intensity{};      ///< NaN without effect `threshold`, since no power is computed then.
  bool has_threshold{};   ///< If false, no flake is too weak.
  std::uint32_t label{};  ///< Label of flakes.
  ThresholdParameters threshold;
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

/// Effect `snow`: flakes near the sensor send echoes in empty beams or instead of a surface.
///
///   P(a flake answers) = 1 - exp(-snow_echoes_per_mmph * S)            (Poisson, S in mm/h)
///   its range r ~ Maxwell(snow_range_scale): scale * sqrt(n1^2 + n2^2 + n3^2), n ~ N(0, 1)
///
/// A flake is not detected if it is farther than the surface, nearer than range_min, or too weak
/// for effect `threshold` (if that is on; with intensity snow_intensity and the fog's attenuation).
/// Else the outcome becomes clutter. The outcomes near_range, ego and sensor_dropout are kept. The
/// publication describes the effect only in words; Maxwell's law is that of detectable particles in
/// a diverging beam (docs/physics.md 4.2).
inline void ApplySnowClutter(DetectTile& tile, const SnowParameters& parameters) {
  const LaneKey key{parameters.seed, RandomUse::kSnow, tile.frame};
  const SnowParameters p = parameters;  // The copy cannot alias the tile.
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float u = LaneUnit(LaneWords(key, tile.firing[i], 0).a);
    const Normals n = LaneNormals(LaneWords(key, tile.firing[i], 1));
    const float r = p.range_scale_m * std::sqrt(n.a * n.a + n.b * n.b + n.c * n.c);
    const float ratio = p.intensity * Exp(-p.threshold.fog_density_per_m * r) *
                        p.threshold.inverse_threshold_m2 / (r * r);
    const std::uint32_t before = tile.outcome[i];
    const std::uint32_t blocked =
        static_cast<std::uint32_t>(before == static_cast<std::uint32_t>(Outcome::kNearRange) ||
                                   before == static_cast<std::uint32_t>(Outcome::kEgo) ||
                                   before == static_cast<std::uint32_t>(Outcome::kSensorDropout));
    // The range of a missing surface is NaN, which fails the comparison: no flake is behind it.
    // Bitwise operators, unlike branches, allow the loop to be vectorised.
    const bool answers = ((blocked == 0U) & !(r >= tile.true_range_m[i]) & (u < p.probability) &
                          (r >= p.range_min_m) & ((ratio >= 1.0F) | !p.has_threshold));
    tile.outcome[i] = answers ? static_cast<std::uint32_t>(Outcome::kClutter) : before;
    tile.clutter[i] = answers ? p.label : tile.clutter[i];
    tile.true_range_m[i] = answers ? r : tile.true_range_m[i];
    tile.intensity[i] = answers ? p.intensity : tile.intensity[i];
    tile.power_ratio[i] = answers ? ratio : tile.power_ratio[i];
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_PUBLISHED_H_
