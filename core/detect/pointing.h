// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_POINTING_H_
#define RAILCAST_DETECT_POINTING_H_

#include <cmath>

#include "core/detect/detect_tile.h"
#include "core/detect/effect_parameters.h"
#include "core/detect/lane_random.h"
#include "core/trace/ray_tile.h"

namespace railcast::RAILCAST_ISA {

/// Effect `pointing_jitter`: the ray leaves beside the direction that the sensor reports, by
/// independent normal deviates along the beam's horizontal and vertical axes. The measured point
/// keeps the reported direction. Lane i of `tile` is lane i of `rays`.
inline void ApplyPointing(RayTile& rays,
                          const DetectTile& tile,
                          const BeamFrame& beam,
                          const PointingParameters& p) {
  const LaneKey key{p.seed, RandomUse::kPointing, tile.frame};
  const BeamFrame b = beam;  // Copies: no store to the rays can change them.
  const float sigma_rad = p.sigma_rad;
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float dx = rays.direction_x[i];
    const float dy = rays.direction_y[i];
    const float dz = rays.direction_z[i];
    const float hx = b.up[1] * dz - b.up[2] * dy;
    const float hy = b.up[2] * dx - b.up[0] * dz;
    const float hz = b.up[0] * dy - b.up[1] * dx;
    const float inverse_norm = 1.0F / std::sqrt(hx * hx + hy * hy + hz * hz + 1e-20F);
    const Normals n = LaneNormals(LaneWords(key, tile.firing[i], 0));
    const float h = sigma_rad * n.a * inverse_norm;
    const float v = sigma_rad * n.b * inverse_norm;
    const float x = dx + h * hx + v * (dy * hz - dz * hy);
    const float y = dy + h * hy + v * (dz * hx - dx * hz);
    const float z = dz + h * hz + v * (dx * hy - dy * hx);
    const float per_norm = 1.0F / std::sqrt(x * x + y * y + z * z);
    rays.direction_x[i] = x * per_norm;
    rays.direction_y[i] = y * per_norm;
    rays.direction_z[i] = z * per_norm;
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_POINTING_H_
