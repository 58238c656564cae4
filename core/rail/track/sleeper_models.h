#pragma once

#include "core/rail/rail_surfaces.h"
#include "core/scene/mesh.h"

namespace railcast {

/// A B70 sleeper in the track frame: 2600 x 300 mm, 214 mm high below the rail, 234 mm outside of
/// it and 175 mm in the middle, where it is 220 mm wide; W14 fastenings on rail seats canted 1:40.
[[nodiscard]] Model MakeConcreteSleeper(const RailSurfaces& surfaces);

/// A wooden sleeper in the track frame: 2600 x 260 x 160 mm, with baseplates canted 1:40.
[[nodiscard]] Model MakeWoodSleeper(const RailSurfaces& surfaces);

}  // namespace railcast
