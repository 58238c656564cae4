#pragma once

#include "core/rail/rail_surfaces.h"
#include "core/scene/mesh.h"

namespace railcast {

/// Freight wagons of 5700 to 6600 triangles each. Frame: origin in the middle of the wagon at top
/// of rail, x along it, y left, z up; metres. The flanges reach kFlangeHeight_m below the origin.
/// Dimensions: physics.md 7.3 (DB Cargo's wagon catalogue, UIC standard parts).

/// Eaos: high-sided open wagon. 14.04 over buffers, pivots 9.0 apart, floor 1.24 above top of rail,
/// inside 12.8 x 2.76 x 2.10, 3.0 wide.
[[nodiscard]] Model MakeOpenWagon(const RailSurfaces& surfaces);

/// Sgns: 60-foot container wagon without floor. 19.74 over buffers, pivots 14.2 apart, fish-bellied
/// side sills, container supports 1.16 above top of rail with spigots on top.
[[nodiscard]] Model MakeFlatWagon(const RailSurfaces& surfaces);

/// Zacns: tank wagon. 16.0 over buffers, pivots 10.5 apart, tank of 2.9 diameter, manhole
/// cover 4.27 above top of rail, with ladders, walkway and end platform.
[[nodiscard]] Model MakeTankWagon(const RailSurfaces& surfaces);

}  // namespace railcast
