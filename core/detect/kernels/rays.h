// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_RAYS_H_
#define RAILCAST_DETECT_RAYS_H_

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/detect/base/beam_axes.h"
#include "core/detect/base/detect_tile.h"
#include "core/detect/base/effect_parameters.h"
#include "core/detect/base/lane_random.h"
#include "core/detect/base/vector_math.h"
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

/// Draws the turns of a tile's firings.
inline void DrawPatternTurns(const DetectTile& tile, std::uint64_t seed, PatternTurns& turns) {
  const LaneKey key{seed, RandomUse::kFootprint, tile.frame};
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float turn = LaneUnit(LaneWords(key, tile.firing[i], 0).a);
    CosSinTurn(turn, turns.cosine[i], turns.sine[i]);
  }
}

/// Aims the sub-rays of the beam in a lane of a tile: its pattern, turned about its axis.
inline void AimSubRays(const RayTile& tile,
                       std::size_t lane,
                       const BeamFrame& frame,
                       const SubRayAim& aim,
                       BeamRays& beam) {
  const Direction d{tile.direction_x[lane], tile.direction_y[lane], tile.direction_z[lane]};
  const BeamAxes axes = AxesOf(d, frame);
  const float per_unit = 1.0F / LengthOf(axes);
  const float sigma_h = frame.sigma_h_rad * per_unit;
  const float sigma_v = frame.sigma_v_rad * per_unit;
  beam.mask = tile.mask;
  beam.shutter = tile.shutter[lane];
  beam.origin[0] = tile.origin_x[lane];
  beam.origin[1] = tile.origin_y[lane];
  beam.origin[2] = tile.origin_z[lane];
  const float axis[3] = {d.x, d.y, d.z};
  const float h[3] = {axes.h.x, axes.h.y, axes.h.z};
  const float v[3] = {axes.v.x, axes.v.y, axes.v.z};
  for (int i = 0; i < 3; ++i) {
    beam.axis[i] = axis[i];
    beam.half_h[i] = aim.largest_offset * sigma_h * h[i];
    beam.half_v[i] = aim.largest_offset * sigma_v * v[i];
  }
  const float cosine = aim.cosine;
  const float sine = aim.sine;
  for (std::size_t i = 0; i < aim.num; ++i) {
    const float turned_h = cosine * aim.h[i] - sine * aim.v[i];
    const float turned_v = sine * aim.h[i] + cosine * aim.v[i];
    const Direction ray = Beside(d, axes, sigma_h * turned_h, sigma_v * turned_v);
    beam.direction_x[i] = ray.x;
    beam.direction_y[i] = ray.y;
    beam.direction_z[i] = ray.z;
  }
}

/// Computes cos_incidence, the cosine of the angle of incidence; NaN where nothing was hit. Lane i
/// of `tile` is lane i of `rays`.
inline void ApplyIncidence(const RayTile& rays, DetectTile& tile) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float nx = rays.normal_x[i];
    const float ny = rays.normal_y[i];
    const float nz = rays.normal_z[i];
    const float along =
        nx * rays.direction_x[i] + ny * rays.direction_y[i] + nz * rays.direction_z[i];
    const float n2 = nx * nx + ny * ny + nz * nz;
    const float cosine = std::fabs(along) / std::sqrt(n2);
    const float bounded = cosine > 1.0F ? 1.0F : cosine;
    // Without a hit the normal is 0. The NaN is not left to 0 / 0: its sign would differ from that
    // of the range's NaN, and which of the two a product takes depends on the instruction set.
    tile.cos_incidence[i] = n2 > 0.0F ? bounded : kNaN;
  }
}

/// Computes normal_up, which is negative for the underside of a surface, and spread_m, the standard
/// deviation of the range over the beam's profile on the tangent plane. Both are 0 where nothing
/// was hit.
///
///   spread = R / |n.d| * hypot(sigma_h n.h, sigma_v n.v)
///
/// with n the surface normal, d the beam, h = up x d and v = d x h its horizontal and vertical axes
/// (unit length). This follows from the plane's range R n.d / n.(d + a h + b v), linearised in the
/// small angles a and b.
inline void ApplySpread(const RayTile& rays, const BeamFrame& beam, DetectTile& tile) {
  const BeamFrame b = beam;  // The copy cannot alias the tile.
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float nx = rays.normal_x[i];
    const float ny = rays.normal_y[i];
    const float nz = rays.normal_z[i];
    const float dx = rays.direction_x[i];
    const float dy = rays.direction_y[i];
    const float dz = rays.direction_z[i];
    const BeamAxes axes = AxesOf({dx, dy, dz}, b);
    const float along = nx * dx + ny * dy + nz * dz;
    const float slope_h = b.sigma_h_rad * (nx * axes.h.x + ny * axes.h.y + nz * axes.h.z);
    const float slope_v = b.sigma_v_rad * (nx * axes.v.x + ny * axes.v.y + nz * axes.v.z);
    const float n2 = nx * nx + ny * ny + nz * nz;
    const float slope2 =
        (slope_h * slope_h + slope_v * slope_v) / (axes.length2 * (along * along + 1e-12F * n2));
    // The normal of the side that faces the sensor, whichever way the surface is wound.
    const float wound_up = nx * b.vertical[0] + ny * b.vertical[1] + nz * b.vertical[2];
    const float up = along > 0.0F ? -wound_up : wound_up;
    tile.spread_m[i] = n2 > 0.0F ? rays.range_m[i] * std::sqrt(slope2) : 0.0F;
    tile.normal_up[i] = n2 > 0.0F ? up / std::sqrt(n2) : 0.0F;
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_RAYS_H_
