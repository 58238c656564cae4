#pragma once

#include <memory>
#include <vector>

#include "core/rail/rail_surfaces.h"
#include "core/rail/world_spec.h"
#include "core/scene/mesh.h"

namespace railcast {

/// Things that stand along the line again and again.
struct InfrastructureModels {
  /// In the track frame; their rail seats fit the rails of RailSection. 92 (concrete) and 12 (wood)
  /// triangles, and 168 in pads or plates and fastenings.
  std::shared_ptr<const Model> concrete_sleeper;
  std::shared_ptr<const Model> wood_sleeper;

  /// Upright; origin at the mast's middle at the height of top of rail.
  std::shared_ptr<const Model> mast;
};

[[nodiscard]] InfrastructureModels MakeInfrastructureModels(const WorldSpec& spec,
                                                            const RailSurfaces& surfaces);

}  // namespace railcast
