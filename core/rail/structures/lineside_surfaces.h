#pragma once

#include "core/rail/rail_surfaces.h"

namespace railcast {

/// The surfaces of single things beside and in the track, looked up by name where a world has any.
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

  /// Sets all materials and labels to 0, for geometry that is built only to be checked.
  LinesideSurfaces() = default;
  /// @throws InputError with a line for every name that the tables lack.
  LinesideSurfaces(const LabelTable& labels, const MaterialLibrary& materials);
};

}  // namespace railcast
