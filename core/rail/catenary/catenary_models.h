#pragma once

#include "core/rail/catenary/catenary_plan.h"
#include "core/rail/rail_surfaces.h"
#include "core/rail/world_spec.h"
#include "core/scene/mesh.h"

namespace railcast {

/// An HEB 240 on a concrete block, upright; origin at its middle at the height of top of rail. At
/// least 8 m high above it, more where the wires ask for it. 54 triangles.
[[nodiscard]] Model MakeMast(const CatenarySpec& spec, const RailSurfaces& surfaces);

/// Where the mast's middle is in the frame of WorldFromSupport.
[[nodiscard]] Vector3 MastFoot_m(const MastSite& site);

/// A cantilever in the frame of WorldFromSupport: a top tube from the mast to the messenger, a
/// strut below it, both on ceramic insulators, a registration tube, and the steady arm that pulls
/// the contact wire to its stagger. Tubes of 42 and 60 mm. 620 triangles.
[[nodiscard]] Model MakeCantilever(const CatenarySpec& spec,
                                   const MastSite& site,
                                   double stagger_m,
                                   const RailSurfaces& surfaces);

}  // namespace railcast
