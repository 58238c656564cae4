// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_POINTING_H_
#define RAILCAST_DETECT_POINTING_H_

#include "core/detect/base/beam_axes.h"
#include "core/detect/base/detect_tile.h"
#include "core/detect/base/effect_parameters.h"
#include "core/detect/base/lane_random.h"
#include "railcast/ray_caster.h"

namespace railcast::RAILCAST_ISA {

/// Effect `pointing_jitter`: the ray deviates from the direction that the sensor reports by
/// independent normal deviates along the beam's horizontal and vertical axes. The measured point
/// keeps the reported direction. Lane i of `tile` is lane i of `rays`.
inline void ApplyPointing(RayTile& rays,
                          const DetectTile& tile,
                          const BeamFrame& beam,
                          const PointingParameters& p) {
  const LaneKey key{p.seed, RandomUse::kPointing, tile.frame};
  const BeamFrame b = beam;  // Copies cannot alias the rays.
  const float sigma_rad = p.sigma_rad;
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const Direction d{rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]};
    const Normals n = LaneNormals(LaneWords(key, tile.firing[i], 0));
    const BeamAxes axes = AxesOf(d, b);
    const float per_unit = 1.0F / LengthOf(axes);
    const Direction aim = Beside(d, axes, sigma_rad * n.a * per_unit, sigma_rad * n.b * per_unit);
    rays.direction_x[i] = aim.x;
    rays.direction_y[i] = aim.y;
    rays.direction_z[i] = aim.z;
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_POINTING_H_
