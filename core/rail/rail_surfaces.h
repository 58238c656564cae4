#pragma once

#include <cstdint>
#include <string_view>

#include "railcast/frame.h"
#include "railcast/material.h"

namespace railcast {

/// Material and label of a triangle.
struct SurfaceClass {
  std::uint16_t material{};
  std::uint32_t label{};
};

/// The surfaces of structures (railcast/structures.h). Tables need their names only if the world
/// has structures.
struct StructureSurfaces {
  SurfaceClass platform, platform_strip, platform_roof;
  SurfaceClass noise_wall, noise_wall_post, fence, retaining_wall, cable_trough;
  SurfaceClass tunnel, tunnel_handrail, bridge, bridge_railing;
  SurfaceClass third_rail, third_rail_shield, slab_track;
};

/// The surfaces of the railway world, looked up by name once.
struct RailSurfaces {
  SurfaceClass rail_head, rail_side, fastening;
  SurfaceClass sleeper_concrete, sleeper_wood, ballast;
  SurfaceClass ground, grass, leaf, bark;
  SurfaceClass gravel, meadow;        ///< Ground with other covers.
  SurfaceClass bush_leaf, bush_bark;  ///< All 0 unless AddBushSurfaces() was called.
  SurfaceClass contact_wire, messenger_wire, dropper, mast, cantilever, insulator;
  SurfaceClass wagon_body, wagon_frame, wheel, tank;
  SurfaceClass skin, clothing, pole, box;
  StructureSurfaces structures;  ///< All 0 unless AddStructureSurfaces() was called.

  /// Sets all materials and labels to 0, for geometry that is built only to be checked.
  RailSurfaces() = default;
  /// @throws InputError with a line for every name that the tables lack.
  RailSurfaces(const LabelTable& labels, const MaterialLibrary& materials);

  /// Looks up the surfaces of bushes, which tables need only if the world has any.
  /// @throws InputError with a line for every name that the tables lack.
  void AddBushSurfaces(const LabelTable& labels, const MaterialLibrary& materials);
  /// Looks up the surfaces of structures.
  /// @throws InputError with a line for every name that the tables lack.
  void AddStructureSurfaces(const LabelTable& labels, const MaterialLibrary& materials);
};

/// Whether the railway itself or one of its models has surfaces of the material.
[[nodiscard]] bool IsRailMaterial(std::string_view name);
/// Whether any structure has surfaces of the material.
[[nodiscard]] bool IsStructureMaterial(std::string_view name);

}  // namespace railcast
