// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_SUB_RAY_AIM_H_
#define RAILCAST_DETECT_SUB_RAY_AIM_H_

#include <cstddef>
#include <cstdint>

#include "core/detect/base/beam_axes.h"
#include "core/detect/base/detect_tile.h"
#include "core/detect/base/effect_parameters.h"
#include "core/detect/base/lane_random.h"
#include "core/detect/base/vector_math.h"
#include "railcast/ray_caster.h"

namespace railcast::RAILCAST_ISA {

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

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_SUB_RAY_AIM_H_
