#pragma once

#include <cstddef>
#include <cstdint>

namespace railcast {

/// Attributes of a surface that a ray can hit. Index 0 of a surface table means "nothing".
struct Surface {
  std::uint32_t label{};
  std::uint32_t instance{};
  float reflectivity{};
  std::uint16_t material{};
  bool is_ego{};
};

/// Number of rays that are traced and detected together: a whole number of packets, and few enough
/// that a tile's arrays stay in the first-level cache.
inline constexpr std::size_t kTileSize = 256;

/// Masks for RayTile::mask: the surfaces that a tile's rays can hit.
inline constexpr std::uint32_t kAllSurfaces = 0xFFFFFFFFU;
/// Parts with Part::is_wire; all others have mask 0x1.
inline constexpr std::uint32_t kWireSurfaces = 0x2U;
inline constexpr std::uint32_t kAllButWires = ~kWireSurfaces;

/// Rays and their hits, in the window frame, as a struct of arrays.
///
/// If a caster finds a surface nearer than `range_m`, it lowers `range_m` and sets `surface` and
/// the normal; otherwise it leaves all three unchanged. Several casters may therefore run one after
/// another on the same tile. Before the first, `range_m` is the maximum range and `surface` is 0.
struct alignas(64) RayTile {
  std::size_t num_rays{};  ///< A multiple of kPacketSize.
  /// kAllButWires where wires are found by other means (effect thin_conductors).
  std::uint32_t mask = kAllSurfaces;

  float origin_x[kTileSize], origin_y[kTileSize], origin_z[kTileSize];           ///< m
  float direction_x[kTileSize], direction_y[kTileSize], direction_z[kTileSize];  ///< Unit length.
  float shutter[kTileSize];  ///< Time of the ray within the frame: 0 = stamp, 1 = last firing.

  float range_m[kTileSize];
  std::uint32_t surface[kTileSize];  ///< Index into a surface table; 0 = nothing.
  /// Normal of the surface hit: any non-zero length, either side. 0 where nothing is hit.
  float normal_x[kTileSize], normal_y[kTileSize], normal_z[kTileSize];
};

/// Finds the first surface along rays. railcast brings its own, TraceScene; a host program may
/// supply another one (HostScene).
class RayCaster {
 public:
  virtual ~RayCaster() = default;

  /// Traces all rays of a tile. Must be thread-safe. Rays start at range 0, so that surfaces nearer
  /// than range_min_m block the beam; such hits are rejected after the trace.
  virtual void Cast(RayTile& tile) const = 0;
};

}  // namespace railcast
