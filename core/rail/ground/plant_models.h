#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/ground/plant_dice.h"
#include "railcast/scene.h"

namespace railcast {

inline constexpr double kGrassPatch_m = 2.0;

/// A plant in full detail, and in less for where sensors cannot tell them apart (docs/detail.md).
struct PlantModel {
  std::shared_ptr<const Model> model;
  std::shared_ptr<const std::vector<CoarserModel>> coarser;
  double height_m{};  ///< Height of the highest leaf.
};

/// A square patch of side kGrassPatch_m about the origin: 640 blades in tufts, 15 to 40 cm high, 8
/// to 14 mm wide, with 3 triangles each. The leaf area index is about 0.4 (a meadow has 1 to 4), so
/// that the ground shows through. Roots extend 0.15 m into the ground. Coarser patches have 1/2 to
/// 1/16 of the blades, which are wider.
[[nodiscard]] PlantModel MakeGrassPatch(const std::string& name,
                                        const RailSurfaces& surfaces,
                                        PlantDice dice);

/// Plants that are placed many times. Frames: origin where the plant emerges from the ground, z up.
/// Roots extend slightly below, so that no plant hovers over uneven ground.
struct PlantModels {
  std::vector<PlantModel> broadleaves;  ///< In order of height.
  std::vector<PlantModel> conifers;     ///< In order of height.
  std::vector<PlantModel> grass;        ///< Square patches of kGrassPatch_m.
  std::vector<PlantModel> bushes;       ///< In order of height.
};

/// Makes two broad-leaved trees (7.5 and 11 m), two spruces (7 and 12 m), three patches of grass
/// and two bushes (1 and 2 m), which are low broad-leaved trees with leaves down to the ground.
///
/// Trees consist of trunk, branches and twigs as tapering tubes, and of single leaves. Leaves are
/// triangles of about 8 x 9 cm (spruces: shoots of 11 x 5 cm) at random positions about the twigs,
/// with spherically distributed normals (G = 0.5, docs/physics.md 3.5). Their number is leaf area
/// index x projected crown area / leaf area. To stay below 20 000 triangles per tree, the index is
/// 3.2 (closed stands have 3 to 5) and the leaves are as large as they come beside railway lines.
/// Coarser trees have 1/2 to 1/16 of the leaves, which are larger.
///
/// Of vertical beams, 18 to 26 % pass through the crowns (measured); exp(-G index) is 20 %.
[[nodiscard]] PlantModels MakePlantModels(const RailSurfaces& surfaces, std::uint64_t seed);

}  // namespace railcast
