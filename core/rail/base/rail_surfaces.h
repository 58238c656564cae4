#pragma once

#include <cstdint>
#include <string_view>

#include "railcast/frame.h"
#include "railcast/material.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// Material and label of a triangle.
struct SurfaceClass {
  std::uint16_t material{};
  std::uint32_t label{};

  bool operator==(const SurfaceClass&) const = default;
};

/// The surfaces of single things beside and in the track (railcast/lineside.h).
struct LinesideSurfaces {
  SurfaceClass signal_mast, signal_foot, signal_screen, signal_lamp, signal_board;
  SurfaceClass board_face, board_steel, marker_white, marker_red;
  SurfaceClass balise, relay_box, relay_foot;
  SurfaceClass buffer_frame, buffer_beam, buffer_board;
  SurfaceClass derailer, derailer_machine;
  SurfaceClass slab, asphalt;
  SurfaceClass barrier_white, barrier_red, crossing_steel, crossing_screen, crossing_lamp;
  SurfaceClass wall, flat_roof, tiled_roof, window;
  SurfaceClass furniture_steel, furniture_wood, furniture_glass;

  bool operator==(const LinesideSurfaces&) const = default;
};

/// The surfaces of structures (railcast/structures.h). Tables need their names only if the world
/// has structures.
struct StructureSurfaces {
  SurfaceClass platform, platform_strip, platform_roof;
  SurfaceClass noise_wall, noise_wall_post, fence, retaining_wall, cable_trough;
  SurfaceClass tunnel, tunnel_handrail, bridge, bridge_railing;
  SurfaceClass third_rail, third_rail_shield, slab_track, road;
  LinesideSurfaces lineside;

  bool operator==(const StructureSurfaces&) const = default;
};

/// The surfaces of turnouts (track/track_structure.h). Tables need their names only if the
/// world has turnouts.
struct TurnoutSurfaces {
  SurfaceClass running_band, rail, point_machine;

  bool operator==(const TurnoutSurfaces&) const = default;
};

/// The surfaces of the railway world, looked up by name once.
struct RailSurfaces {
  SurfaceClass rail_head, rail_side, fastening;
  SurfaceClass sleeper_concrete, sleeper_wood, ballast;
  SurfaceClass ground, grass, leaf, bark;
  SurfaceClass gravel, meadow;        ///< Ground with other covers.
  SurfaceClass bush_leaf, bush_bark;  ///< All 0 unless AddBushSurfaces() was called.
  SurfaceClass contact_wire, messenger_wire, dropper, mast, cantilever, insulator;
  SurfaceClass skin, clothing, pole, box;
  StructureSurfaces structures;  ///< All 0 unless AddStructureSurfaces() was called.
  TurnoutSurfaces turnouts;      ///< All 0 unless AddTurnoutSurfaces() was called.

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
  /// Looks up the surfaces of turnouts.
  /// @throws InputError with a line for every name that the tables lack.
  void AddTurnoutSurfaces(const LabelTable& labels, const MaterialLibrary& materials);

  bool operator==(const RailSurfaces&) const = default;
};

/// Returns the model's part with that surface; adds the part if there is none yet. The reference is
/// valid until the next part is added.
[[nodiscard]] Part& PartOf(const SurfaceClass& surface, Model& model);
[[nodiscard]] inline Mesh& MeshOf(const SurfaceClass& surface, Model& model) {
  return PartOf(surface, model).mesh;
}

/// Adds another model's parts to those of the same surfaces.
void AppendModel(const Model& other, const Transform& model_from_other, Model& model);

/// Whether the railway itself or one of its models has surfaces of the material.
[[nodiscard]] bool IsRailMaterial(std::string_view name);
/// Whether any structure or turnout has surfaces of the material.
[[nodiscard]] bool IsStructureMaterial(std::string_view name);

}  // namespace railcast
