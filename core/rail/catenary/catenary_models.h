#pragma once

#include "core/rail/catenary/support_layout.h"
#include "core/rail/rail_surfaces.h"
#include "core/rail/world_spec.h"
#include "core/scene/mesh.h"

namespace railcast {

/// An HEB 240 on a concrete block, upright; origin at its middle at the height of top of rail. At
/// least 8 m high above it, more where the wires ask for it. 54 triangles.
[[nodiscard]] Model MakeMast(const CatenarySpec& spec, const RailSurfaces& surfaces);

/// A beam of HEB 240 upon its two masts and the posts of the same section that hang from it, as far
/// as the lower hinges of their cantilevers. In the frame of WorldFromSupport of a track at offset
/// 0. 44 triangles and as many for each post.
/// @param shift_m PantographShift_m() there.
[[nodiscard]] Model MakePortal(const CatenarySpec& spec,
                               const PortalSite& site,
                               double shift_m,
                               const RailSurfaces& surfaces);

/// A cantilever in the frame of WorldFromSupport: a top tube from the mast to the messenger, a
/// strut below it, both on ceramic insulators, a registration tube, and the steady arm that pulls
/// the contact wire to its stagger. Tubes of 42 and 60 mm. 620 triangles.
/// @param face_m Of the mast or post that holds it, left positive.
[[nodiscard]] Model MakeCantilever(const CatenarySpec& spec,
                                   double face_m,
                                   double stagger_m,
                                   const RailSurfaces& surfaces);

}  // namespace railcast
