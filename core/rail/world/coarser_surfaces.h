#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/rail/chunk/chunk_context.h"
#include "core/rail/chunk/sweep.h"
#include "core/rail/landform/landform.h"
#include "railcast/alignment.h"
#include "railcast/scene.h"

namespace railcast {

// What permits the coarser forms of a chunk (docs/detail.md). Ballast has cells of up to 0.48 m
// across in the first, 2.5 spacings; along the track, where it is as fine as ever, most beams run.
// Beams that are narrower than the spacing find the ground's edges behind its bumps: their width
// counts, too.
inline constexpr double kCoarseRaySpacings_m[kMostCoarse] = {
    0.19, std::numeric_limits<double>::infinity()};
inline constexpr double kCoarseBeamWidth_m = 0.2;
inline constexpr double kCoarseSightAngle_rad = 0.5;

/// What permits the coarser forms of the chunk between two chainages.
[[nodiscard]] inline std::vector<CoarserSurfaces> CoarserSurfacesBetween(
    const ChainageRange& range,
    const Alignment& alignment,
    const StripWidth& width,
    const Transform& chunk_from_world) {
  constexpr int kNumSteps = 10;
  // By how much a curve turns the track at the chunk's ends from its middle.
  const double turn_rad = 0.5 * std::abs(alignment.At(range.end_s_m).heading_rad -
                                         alignment.At(range.begin_s_m).heading_rad);
  CoarserSurfaces coarser{.area_m = {},
                          .ray_spacing_m = 0.0,
                          .beam_width_m = kCoarseBeamWidth_m,
                          .sight_angle_rad = std::max(0.0, kCoarseSightAngle_rad - turn_rad)};
  for (int i = 0; i <= kNumSteps; ++i) {
    const double s_m = std::lerp(range.begin_s_m, range.end_s_m, 1.0 * i / kNumSteps);
    for (const double side : {-1.0, 1.0}) {
      const Transform chunk_from_edge =
          chunk_from_world * alignment.WorldFromTrack(s_m, side * width.At(s_m, side));
      coarser.area_m.extend(Eigen::Vector2d(chunk_from_edge.translation().head<2>()));
    }
  }
  std::vector<CoarserSurfaces> forms(kMostCoarse, coarser);
  for (std::size_t i = 0; i < forms.size(); ++i) forms[i].ray_spacing_m = kCoarseRaySpacings_m[i];
  return forms;
}

}  // namespace railcast
