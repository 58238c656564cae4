#pragma once

#include <cstddef>
#include <cstdint>

#include "core/trace/ray_tile.h"

namespace railcast {

/// The firings of one RayTile on their way from a hit to a return. Struct of arrays, so that every
/// effect is a loop over lanes; 4-byte lanes throughout, so that compilers vectorise the loops.
struct alignas(64) DetectTile {
  std::size_t num_rays{};
  std::uint32_t frame{};  ///< Frame index: part of every random key.

  std::uint32_t firing[kTileSize];  ///< Firing index: part of every random key.
  float direction_x[kTileSize], direction_y[kTileSize], direction_z[kTileSize];  ///< Sensor frame.

  float true_range_m[kTileSize];  ///< Of the surface; NaN where there is none.
  float cos_incidence[kTileSize];
  float reflectivity[kTileSize];

  std::uint32_t outcome[kTileSize];   ///< An Outcome.
  std::uint32_t is_flake[kTileSize];  ///< 1 where snow answers instead of a surface, else 0.
  float intensity[kTileSize];         ///< Effective reflectance, unattenuated; NaN if not computed.
  float power_ratio[kTileSize];       ///< Received / threshold; NaN if not computed.
  float incidence_rad[kTileSize];
  float range_m[kTileSize];  ///< Measured; NaN where the outcome has no point.
  float x[kTileSize], y[kTileSize], z[kTileSize];  ///< Measured, sensor frame; NaN likewise.
};

}  // namespace railcast
