#pragma once

#include <vector>

#include "railcast/scene.h"

namespace railcast {

/// How far a simplified mesh may be from what it was made of.
struct SimplifyLimits {
  double deviation_m{};  ///< Of the surfaces, in both directions.
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

}  // namespace railcast
