#pragma once

#include <algorithm>
#include <cstddef>

#include "railcast/ray_caster.h"

namespace railcast {

/// Copies where the first sub-rays of a beam begin and lead, and when, to the first rays of a tile.
inline void CopySubRays(const BeamRays& beam, std::size_t num_rays, RayTile& tile) {
  std::fill_n(tile.origin_x, num_rays, beam.origin[0]);
  std::fill_n(tile.origin_y, num_rays, beam.origin[1]);
  std::fill_n(tile.origin_z, num_rays, beam.origin[2]);
  std::copy_n(beam.direction_x, num_rays, tile.direction_x);
  std::copy_n(beam.direction_y, num_rays, tile.direction_y);
  std::copy_n(beam.direction_z, num_rays, tile.direction_z);
  std::fill_n(tile.shutter, num_rays, beam.shutter);
}

}  // namespace railcast
