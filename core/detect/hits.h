#pragma once

#include <vector>

#include "core/detect/beam_optics.h"
#include "core/detect/detect_tile.h"
#include "core/trace/ray_tile.h"
#include "core/trace/surface.h"

namespace railcast {

/// What the rays' surface indices mean.
struct SurfaceTable {
  const std::vector<Surface>& surfaces;
  const std::vector<LaneOptics>& optics;  ///< By material; empty if no physical effect is on.
};

/// Hands what the rays hit to the detector: surface, range, reflectivity, optics and a first
/// outcome (no_surface, ego or returned), as one echo of the whole beam. Lane i of `tile` is lane i
/// of `rays`.
void ResolveHits(const RayTile& rays, const SurfaceTable& table, DetectTile& tile);

}  // namespace railcast
