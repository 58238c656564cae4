#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

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

/// The number of sub-rays that sample the cross-section of a beam: whole packets.
inline constexpr std::size_t kNumSubRays = 64;
/// How many sub-rays, the first ones, sample a beam that meets a crowd of small surfaces, or every
/// beam if BeamSpec::footprint_rays is this number.
inline constexpr std::size_t kNumCrowdedSubRays = 16;
/// The largest number of sub-rays of a beam, for a closer look at it.
inline constexpr std::size_t kNumCloserSubRays = 4 * kNumSubRays;
static_assert(kNumCloserSubRays <= kTileSize);

/// A flat piece of a surface that sub-rays of a beam hit.
struct Facet {
  std::uint32_t surface{};                   ///< Index into a surface table; 0 = nothing.
  float normal_x{}, normal_y{}, normal_z{};  ///< Any non-zero length, either side.
};

/// The sub-rays of one beam and their hits, in the window frame.
///
/// Sub-rays that hit the same facet share an entry of `facets`. If a caster finds a surface nearer
/// than `range_m[i]`, it lowers `range_m[i]` and points `facet[i]` to an entry that it has added;
/// otherwise it leaves both unchanged. Several casters may therefore run one after another. Before
/// the first, `range_m` is the maximum range, and `facets` consists of entry 0, which means
/// "nothing". Entries may be left without a sub-ray.
struct alignas(64) BeamRays {
  /// More facets than sub-rays, so that a caster need not look for entries to reuse at every hit.
  static constexpr std::size_t kMaxFacets = kNumCloserSubRays + kNumSubRays;

  std::uint32_t mask = kAllSurfaces;  ///< As RayTile::mask.
  float shutter{};                    ///< As RayTile::shutter, for the whole beam.
  /// A multiple of kNumSubRays, or kNumCrowdedSubRays. A caster may lower it to kNumCrowdedSubRays
  /// where the beam meets so many small surfaces that these sample it well enough; the other
  /// sub-rays then have no meaning.
  std::size_t num_rays = kNumSubRays;
  /// The number of triangles that casters have intersected with sub-rays so far.
  std::uint32_t num_met = 0;
  /// Lower bound of the ranges of surfaces in the ellipse that no sub-ray meets: thin things and
  /// edges. A caster that notices such a surface lowers it.
  float missed_m = std::numeric_limits<float>::infinity();
  float origin[3]{};  ///< m
  float axis[3]{};    ///< Direction of the beam's axis; unit length.
  /// The semi-axes of the ellipse that contains all sub-rays: every direction is a multiple of
  /// axis + a half_h + b half_v with a^2 + b^2 <= 1. Perpendicular to `axis`.
  float half_h[3]{}, half_v[3]{};

  float direction_x[kNumCloserSubRays], direction_y[kNumCloserSubRays],
      direction_z[kNumCloserSubRays];  ///< Unit length.
  float range_m[kNumCloserSubRays];
  std::uint32_t facet[kNumCloserSubRays];  ///< Index into `facets`.

  std::uint32_t num_facets = 1;
  Facet facets[kMaxFacets];
};

/// Finds the first surface along rays. railcast brings its own, TraceScene; a host program may
/// supply another one (HostScene, examples/own_ray_caster.cpp).
class RayCaster {
 public:
  virtual ~RayCaster() = default;

  /// Traces all rays of a tile. Must be thread-safe. Rays start at range 0, so that surfaces nearer
  /// than range_min_m block the beam; such hits are rejected after the trace.
  virtual void Cast(RayTile& tile) const = 0;

  /// Traces the sub-rays of a beam. Must be thread-safe. This implementation passes them to Cast();
  /// a caster that exploits how close together they are can be several times faster.
  virtual void CastBeam(BeamRays& beam) const;

  /// Whether any ray within the ellipse of a beam's sub-rays may meet a surface of
  /// BeamSpec::footprint_of nearer than `range_m[0]`, even if others hide it. It may be true where
  /// no ray does, but never false where one does; this implementation always returns true. Must be
  /// thread-safe. Of the sub-rays' arrays, only `range_m[0]` is set.
  [[nodiscard]] virtual bool NeedsWidth(const BeamRays& beam) const;
};

}  // namespace railcast
