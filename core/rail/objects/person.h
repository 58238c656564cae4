#pragma once

#include "core/rail/rail_surfaces.h"
#include "core/scene/mesh.h"

namespace railcast {

inline constexpr double kPersonHeight_m = 1.75;

/// An adult in working clothes in mid-stride, about 1700 triangles. Frame: origin on the ground
/// between the feet, x the way the person looks, y left, z up; metres. Proportions are those of a
/// median adult (DIN 33402-2), all scaled alike to `height_m`, which is met exactly.
[[nodiscard]] Model MakePerson(const RailSurfaces& surfaces, double height_m = kPersonHeight_m);

}  // namespace railcast
