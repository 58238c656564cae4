#pragma once

#include <cstddef>
#include <cstdint>

#include "core/trace/ray_tile.h"

namespace railcast {

/// DetectTile::clutter of what a surface answers.
inline constexpr std::uint32_t kNoClutter = 0xFFFFFFFFU;

/// Up to kTileSize echoes on their way from a hit to a return: each lane is an echo of one firing.
/// Struct of arrays, so that every effect is a loop over lanes; 4-byte lanes throughout, so that
/// compilers vectorise the loops.
struct alignas(64) DetectTile {
  std::size_t num_rays{};  ///< Lanes in use.
  std::uint32_t frame{};   ///< Frame index: part of every random key.

  std::uint32_t firing[kTileSize];   ///< Firing index: part of every random key ...
  std::uint32_t echo[kTileSize];     ///< ... and so is the echo's number within its firing.
  std::uint32_t channel[kTileSize];  ///< Row of the firing.
  float direction_x[kTileSize], direction_y[kTileSize], direction_z[kTileSize];  ///< Sensor frame.

  std::uint32_t surface[kTileSize];  ///< Index into the frame's surface table; 0 = nothing.
  float true_range_m[kTileSize];     ///< Of the surface; NaN where there is none.
  float cos_incidence[kTileSize];    ///< |direction . normal|, in [0, 1]; NaN likewise.
  float normal_up[kTileSize];        ///< |vertical part of the unit normal|.
  float spread_m[kTileSize];         ///< Standard deviation of the range inside the beam.
  float share[kTileSize];            ///< Of the beam's power that met this.
  float peak_shift_m[kTileSize];     ///< From the true range to where the echo peaks.
  float reflectivity[kTileSize];     ///< Diffuse.
  // The rest of the surface's optics, ready for use; set where effect surface_response is on.
  float diffuse_a[kTileSize], diffuse_b[kTileSize];  ///< Oren and Nayar's A and B x reflectivity.
  float specular_f0[kTileSize];
  float specular_alpha2[kTileSize];  ///< GGX's alpha squared.
  float retro[kTileSize];

  std::uint32_t outcome[kTileSize];  ///< An Outcome.
  std::uint32_t clutter[kTileSize];  ///< Label of what answers without a surface, or kNoClutter.
  float intensity[kTileSize];        ///< Effective reflectance, unattenuated; NaN if not computed.
  float power_ratio[kTileSize];      ///< Received / threshold; NaN if not computed.
  float incidence_rad[kTileSize];
  float range_m[kTileSize];  ///< Measured; NaN where the outcome has no point.
  float x[kTileSize], y[kTileSize], z[kTileSize];  ///< Measured, sensor frame; NaN likewise.
};

}  // namespace railcast
