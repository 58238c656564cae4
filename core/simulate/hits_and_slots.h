#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/detect/detect_tile.h"
#include "core/frame/frame.h"
#include "core/trace/ray_tile.h"
#include "core/trace/surface.h"

namespace railcast {

/// Hands what the rays hit to the detector: range, incidence, reflectivity and a first outcome.
void ResolveHits(const RayTile& rays, const std::vector<Surface>& surfaces, DetectTile& detect);

/// What the surfaces and the flakes of a frame are called.
struct SurfaceNames {
  const std::vector<Surface>& surfaces;
  std::uint32_t snow_label{};
};

/// Where a tile's firings go in a frame. Lanes after num_firings fill up a packet: not stored.
struct SlotRange {
  const std::uint32_t* slots{};
  std::size_t num_firings{};
};

/// Writes a tile's measurement and truth into the frame.
void StoreReturns(const RayTile& rays,
                  const DetectTile& detect,
                  const SurfaceNames& names,
                  const SlotRange& slots,
                  Frame& frame);

}  // namespace railcast
