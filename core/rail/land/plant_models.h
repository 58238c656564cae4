#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/rail/land/grass_patch.h"
#include "core/rail/rail_surfaces.h"
#include "core/scene/mesh.h"

namespace railcast {

struct TreeModel {
  std::shared_ptr<const Model> model;
  double height_m{};  ///< Of its highest leaf.
};

/// Plants that are placed many times over. Frames: origin where the plant leaves the ground, z up;
/// roots reach a little below, so that nothing hovers over rough ground.
struct PlantModels {
  std::vector<TreeModel> broadleaves;               ///< From low to high.
  std::vector<TreeModel> conifers;                  ///< From low to high.
  std::vector<std::shared_ptr<const Model>> grass;  ///< Square patches of kGrassPatch_m.
};

/// Two broad-leaved trees (7.5 and 11 m), two spruces (7 and 12 m) and three patches of grass.
///
/// Trees are trunk, branches and twigs as tapering tubes, and single leaves: triangles of about
/// 8 x 9 cm, for spruces shoots of 11 x 5 cm, in random positions about the twigs and with
/// spherically distributed normals (G = 0.5, physics.md 3). Their number is leaf area index times
/// the crown's projection over the area of a leaf. To stay below 20 000 triangles a tree, the index
/// is 3.2 (closed stands have 3 to 5) and the leaves are at the large end of what grows beside a
/// line. Of vertical beams 18 to 26 % pass through the crowns (measured); exp(-G index) is 20 %.
[[nodiscard]] PlantModels MakePlantModels(const RailSurfaces& surfaces, std::uint64_t seed);

}  // namespace railcast
