#pragma once

#include <memory>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "railcast/rail_world.h"
#include "railcast/scene.h"

namespace railcast {

/// A B70 sleeper in the track frame: 2600 x 300 mm; 214 mm high below the rail, 234 mm outside it
/// and 175 mm in the middle, where it is 220 mm wide; W14 fastenings on rail seats canted 1:40.
/// @param shift_m How much farther from the middle its rails lie, and its ends (RailShift_m).
[[nodiscard]] Model MakeConcreteSleeper(const RailSurfaces& surfaces, double shift_m);

/// A wooden sleeper in the track frame: 2600 x 260 x 160 mm, with baseplates canted 1:40.
[[nodiscard]] Model MakeWoodSleeper(const RailSurfaces& surfaces, double shift_m);

/// Models that are placed repeatedly along the line.
struct InfrastructureModels {
  /// Sleepers in the track frame; their rail seats fit the rails of RailSection. The sleepers have
  /// 92 (concrete) and 12 (wood) triangles, plus 168 for pads or plates and fastenings.
  std::shared_ptr<const Model> concrete_sleeper;
  std::shared_ptr<const Model> wood_sleeper;

  /// Of turnouts (track/turnout_structure.h): bearers from 1.6 m on, each 0.1 m longer.
  std::vector<std::shared_ptr<const Model>> concrete_bearers;
  std::vector<std::shared_ptr<const Model>> wood_bearers;
  std::shared_ptr<const Model> concrete_plate;
  std::shared_ptr<const Model> wood_plate;
  std::shared_ptr<const Model> point_machine;

  /// Upright; the origin is at the mast's middle at the height of top of rail.
  std::shared_ptr<const Model> mast;
};

[[nodiscard]] InfrastructureModels MakeInfrastructureModels(const WorldSpec& spec,
                                                            const RailSurfaces& surfaces);

}  // namespace railcast
