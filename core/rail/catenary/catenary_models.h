#pragma once

#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/catenary/support_layout.h"
#include "railcast/scene.h"
#include "railcast/world_spec.h"

namespace railcast {

/// An upright HEB 240 on a concrete block. The origin is at its middle at the height of top of
/// rail; the mast rises at least 8 m above it, more if the height of the wires requires it. 54
/// triangles.
[[nodiscard]] Model MakeMast(const CatenarySpec& spec, const RailSurfaces& surfaces);

/// The post below the roof of a tunnel or the deck of a bridge that carries a cantilever in place
/// of a mast, HEB 240. Origin as that of a mast. 44 triangles.
[[nodiscard]] Model MakeHangingPost(const CatenarySpec& spec, const RailSurfaces& surfaces);

/// A portal: a beam of HEB 240 on two masts, with posts of the same section that hang from it down
/// to the lower hinges of their cantilevers. In the frame of WorldFromSupport of a track at offset
/// 0. 44 triangles, and 44 more per post.
/// @param shift_m PantographShift_m() at the support.
[[nodiscard]] Model MakePortal(const CatenarySpec& spec,
                               const PortalSite& site,
                               double shift_m,
                               const RailSurfaces& surfaces);

/// A wire on a cantilever.
struct CantileverWire {
  double y_m{};               ///< Lateral position, left positive.
  double contact_lift_m{};    ///< Of its contact wire above contact height.
  double messenger_lift_m{};  ///< Of its messenger above that of a plain wire.
};

/// What a cantilever carries, in the frame of WorldFromSupport.
struct CantileverShape {
  double face_m{};                    ///< Face of the mast or post that carries it, left positive.
  std::vector<CantileverWire> wires;  ///< At least one.
  double room_m{};  ///< Where its room ends on the other side; infinite if it does not.
};

/// A cantilever: a top tube from the mast to the farthest messenger wire, a strut below it, both on
/// ceramic insulators, a registration tube, and for each wire the steady arm that pulls the contact
/// wire to its stagger. Tubes of 42 and 60 mm. 620 triangles with one wire.
[[nodiscard]] Model MakeCantilever(const CatenarySpec& spec,
                                   const CantileverShape& shape,
                                   const RailSurfaces& surfaces);

}  // namespace railcast
