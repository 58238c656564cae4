#pragma once

#include <cstddef>
#include <cstdint>

#include "railcast/ray_caster.h"

namespace railcast {

/// DetectTile::clutter of the echo of a surface.
inline constexpr std::uint32_t kNoClutter = 0xFFFFFFFFU;

/// The number of the first echo of fog within its firing, and how many there may be. The receiver
/// has detected them with its noise (fog_echo.h).
inline constexpr std::uint32_t kFirstFogEcho = 93;
inline constexpr std::uint32_t kNumFogEchoes = 2;

/// Up to kTileSize echoes in the process from hit to return. Each lane is an echo of one firing. A
/// struct of arrays, so that every effect is a loop over lanes; all elements have 4 bytes, so that
/// compilers vectorise the loops.
struct alignas(64) DetectTile {
  std::size_t num_rays{};  ///< Lanes in use.
  std::uint32_t frame{};   ///< Frame index, part of every random key.

  std::uint32_t firing[kTileSize];   ///< Firing index, part of every random key.
  std::uint32_t echo[kTileSize];     ///< Number of the echo within its firing, part of random keys.
  std::uint32_t channel[kTileSize];  ///< Row of the firing.
  float direction_x[kTileSize], direction_y[kTileSize], direction_z[kTileSize];  ///< Sensor frame.

  std::uint32_t surface[kTileSize];  ///< Index into the frame's surface table; 0 = nothing.
  float true_range_m[kTileSize];     ///< Range of the surface; NaN where there is none.
  float cos_incidence[kTileSize];    ///< |direction . normal|, in [0, 1]; NaN without a surface.
  float normal_up[kTileSize];     ///< Vertical component of the unit normal on the sensor's side.
  float spread_m[kTileSize];      ///< Standard deviation of the range within the beam.
  float share[kTileSize];         ///< Share of the beam's power that meets the surface.
  float peak_shift_m[kTileSize];  ///< Range of the echo's peak minus the true range.
  float reflectivity[kTileSize];  ///< Diffuse reflectance; of echoes, of all that the beam meets.
  // The other optical properties of the surface; set if a physical effect is on.
  float diffuse_a[kTileSize], diffuse_b[kTileSize];  ///< LaneOptics::a and b (Oren and Nayar).
  float specular_f0[kTileSize];
  float specular_alpha2[kTileSize];  ///< GGX's alpha squared.
  float retro[kTileSize];

  /// Share of the power that the sensor's window lets through, both ways; set if effect `cover` is
  /// on.
  float cover[kTileSize];
  float bare_ratio[kTileSize];  ///< power_ratio behind a clean window; as `cover`.

  std::uint32_t outcome[kTileSize];  ///< An Outcome.
  std::uint32_t clutter[kTileSize];  ///< Label of a clutter echo, or kNoClutter.
  float intensity[kTileSize];        ///< Effective reflectance, unattenuated; NaN if not computed.
  float power_ratio[kTileSize];      ///< Received / threshold; NaN if not computed.
  /// Half the length over which the echo is above the threshold; set if effect `saturation` is on.
  float busy_m[kTileSize];
  float incidence_rad[kTileSize];
  float range_m[kTileSize];  ///< Measured range; NaN where the outcome has no point.
  float x[kTileSize], y[kTileSize], z[kTileSize];  ///< Measured point, sensor frame; else NaN.
};

}  // namespace railcast
