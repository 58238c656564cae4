#pragma once

#include <string>

#include "core/rail/land/plant_dice.h"
#include "core/rail/rail_surfaces.h"
#include "core/scene/mesh.h"

namespace railcast {

inline constexpr double kGrassPatch_m = 2.0;

/// A square of kGrassPatch_m about the origin: 640 blades in tufts, 15 to 40 cm high, 8 to 14 mm
/// wide and of 3 triangles, a leaf area index of about 0.4, so that the ground shows through, where
/// a meadow has 1 to 4. Roots reach 0.15 m into the ground.
[[nodiscard]] Model MakeGrassPatch(const std::string& name,
                                   const RailSurfaces& surfaces,
                                   PlantDice dice);

}  // namespace railcast
