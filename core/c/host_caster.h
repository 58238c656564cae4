#pragma once

#include <vector>

#include "railcast/c_api.h"
#include "railcast/frame.h"
#include "railcast/material.h"
#include "railcast/ray_caster.h"

namespace railcast {

/// Passes rays to a host's callback and checks what it writes, because a wrong index or a normal of
/// length 0 would otherwise end in a crash or in NaN.
class HostCaster final : public RayCaster {
 public:
  /// @pre `surfaces` outlives the caster.
  HostCaster(railcast_cast_rays cast_rays, void* user, const std::vector<Surface>& surfaces)
      : cast_rays_(cast_rays), user_(user), surfaces_(surfaces) {}

  /// @throws CallbackError "the callback returned 3" or "callback: ray 7 of 256: surface: must be
  ///   less than 4 (got 9)".
  void Cast(RayTile& tile) const override;

 private:
  railcast_cast_rays cast_rays_;
  void* user_;
  const std::vector<Surface>& surfaces_;
};

/// The names that a table of surfaces refers to.
struct SurfaceNames {
  LabelTable labels;
  MaterialLibrary materials;
};

/// A host's table of surfaces as ray casters have it.
/// @throws ArgumentError with a line for every fault: "surfaces[2].material: unknown material, the
///   nearest is "concrete" (got "concret")".
[[nodiscard]] std::vector<Surface> SurfacesOf(const railcast_surface* surfaces,
                                              std::size_t num_surfaces,
                                              const SurfaceNames& names);

}  // namespace railcast
