#pragma once

#include <memory>
#include <vector>

#include "railcast/scene.h"

namespace railcast {

/// How far a simplified mesh may be from what it was made of.
struct SimplifyLimits {
  double deviation_m{};  ///< Deviation of the surfaces, in both directions.
  double normal_deg{};   ///< Between the normal of a triangle and those of the ones it stands for.
};

/// Collapses edges by OpenMesh in the order of the error quadrics of Garland and Heckbert (1997),
/// each only where the distances by which the surface moves with each add up to no more than the
/// deviation, and the normals stay in their cones (ModNormalDeviationT). Of points at borders, only
/// those on straight stretches go (to a thousandth of the deviation). Points that are held stay,
/// and so do those of triangles that OpenMesh cannot hold, as three meet at an edge or two run
/// about it the same way.
///
/// The surface is looked at in few points of each collapse: whether the surfaces keep to `limits`
/// must be measured.
/// @pre No two vertices are in the same place; `is_held` has a value for each.
[[nodiscard]] Mesh CollapseEdges(const Mesh& mesh,
                                 const std::vector<bool>& is_held,
                                 const SimplifyLimits& limits);

struct SimplifiedParts {
  std::vector<Mesh> parts;
  double deviation_m{};  ///< The greatest that was measured; <= SimplifyLimits::deviation_m.
};

/// Meshes with fewer triangles whose surfaces deviate by at most `limits`, one for each of `parts`.
/// Points where parts meet stay.
///
/// What hangs together in a part is simplified by itself (CollapseEdges()). The deviation is then
/// measured in both directions, apart from OpenMesh (MeshSurface). What deviates by more is made
/// again with half the deviation, three times at most, and then left as it is; and so is what would
/// get a triangle without area. The result is the same at any number of threads.
[[nodiscard]] SimplifiedParts Simplified(const std::vector<Mesh>& parts,
                                         const SimplifyLimits& limits);

/// As Simplified(), but made only once in a program for the same triangles and limits: what was
/// made for the last 64 is kept. May be called by several threads.
[[nodiscard]] std::shared_ptr<const SimplifiedParts> SimplifiedOnce(const std::vector<Mesh>& parts,
                                                                    const SimplifyLimits& limits);

}  // namespace railcast
