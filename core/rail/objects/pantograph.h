#pragma once

#include "core/rail/base/rail_surfaces.h"
#include "railcast/scene.h"

namespace railcast {

/// A single-arm pantograph on a roof.
struct PantographPlace {
  double x_m{};               ///< Middle of its base along the vehicle.
  double base_m{};            ///< Top of the roof below it, above top of rail.
  double contact_height_m{};  ///< Upper edge of its contact strips.
  double knee = 1.0;          ///< 1: the knee points to the front; -1: to the back.
};

/// Adds base frame, insulators, arms and the head of 1950 mm width (EN 50367), which carries two
/// contact strips. Frame as in wagon_parts.h.
void AddPantograph(const PantographPlace& place, const RailSurfaces& surfaces, Model& vehicle);

/// Adds an insulator of 0.3 m on a roof.
void AddRoofInsulator(const Vector3& foot_m, const RailSurfaces& surfaces, Model& vehicle);

}  // namespace railcast
