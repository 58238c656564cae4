#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/rail/rail_surfaces.h"
#include "core/rail/world_spec.h"
#include "core/scene/mesh.h"

namespace railcast {

/// The cantilevers of one track, by the side of the pantograph's middle that they hold the wire on.
struct CantileverPair {
  std::shared_ptr<const Model> wire_left;
  std::shared_ptr<const Model> wire_right;
};

/// Things that stand along the line again and again.
struct InfrastructureModels {
  /// In the track frame; their rail seats fit the rails of RailSection. B70: 72 triangles; both
  /// kinds have 168 more in pads or plates and fastenings.
  std::shared_ptr<const Model> concrete_sleeper;
  std::shared_ptr<const Model> wood_sleeper;

  /// Upright; origin at the mast's middle at the height of top of rail.
  std::shared_ptr<const Model> mast;

  /// Of each track of the spec; in the frame of WorldFromSupport. Null where there is no wire.
  std::vector<CantileverPair> cantilevers;
};

[[nodiscard]] InfrastructureModels MakeInfrastructureModels(const WorldSpec& spec,
                                                            const RailSurfaces& surfaces);

}  // namespace railcast
