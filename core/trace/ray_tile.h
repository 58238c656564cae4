#pragma once

#include <cstddef>
#include <cstdint>

namespace railcast {

/// Rays traced and detected together: small enough that a tile's arrays stay in the first-level
/// cache, a whole number of packets.
inline constexpr std::size_t kTileSize = 256;

/// What a tile's rays can hit.
inline constexpr std::uint32_t kAllSurfaces = 0xFFFFFFFFU;
inline constexpr std::uint32_t kWireSurfaces = 0x2U;  ///< Parts that are `is_wire`; others are 0x1.
inline constexpr std::uint32_t kAllButWires = ~kWireSurfaces;

/// Rays and what they hit, in the window frame. Struct of arrays.
///
/// A caster looks for a surface nearer than `range_m` and, if it finds one, lowers `range_m` and
/// sets `surface` and the normal; else it leaves all of them alone. So several casters may
/// follow each other, and a ray starts with its greatest range and surface 0.
struct alignas(64) RayTile {
  std::size_t num_rays{};             ///< A multiple of kPacketSize.
  std::uint32_t mask = kAllSurfaces;  ///< Or kAllButWires, where those are found apart.

  float origin_x[kTileSize], origin_y[kTileSize], origin_z[kTileSize];           ///< m
  float direction_x[kTileSize], direction_y[kTileSize], direction_z[kTileSize];  ///< Unit length.
  float shutter[kTileSize];  ///< When in the frame the ray is cast: 0 = stamp, 1 = last firing.

  float range_m[kTileSize];
  std::uint32_t surface[kTileSize];  ///< Index into a surface table; 0 = nothing.
  /// Of the surface hit: any length but 0, either side. 0 where nothing is hit.
  float normal_x[kTileSize], normal_y[kTileSize], normal_z[kTileSize];
};

/// Finds the first surface along rays. Railcast's own is TraceScene; a host program may bring its
/// own.
class RayCaster {
 public:
  virtual ~RayCaster() = default;

  /// Thread-safe. Rays start at range 0: near occluders block, they are rejected after the trace.
  virtual void Cast(RayTile& tile) const = 0;
};

}  // namespace railcast
