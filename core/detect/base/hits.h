#pragma once

#include <vector>

#include "core/detect/base/beam_optics.h"
#include "core/detect/base/detect_tile.h"
#include "railcast/ray_caster.h"

namespace railcast {

/// The surfaces that the rays' surface indices refer to.
struct SurfaceTable {
  const std::vector<Surface>& surfaces;
  const std::vector<LaneOptics>& optics;  ///< By material; empty if no physical effect is on.
};

/// Copies the hits of the rays into the detector's tile: surface, range, reflectivity, optics and a
/// preliminary outcome (no_surface, ego or returned), as one echo of the whole beam. Lane i of
/// `tile` is lane i of `rays`.
void ResolveHits(const RayTile& rays, const SurfaceTable& table, DetectTile& tile);

}  // namespace railcast
