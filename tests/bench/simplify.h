#pragma once

#include <vector>

#include "railcast/scene.h"

namespace railcast {

/// How far a simplified mesh may be from what it was made of.
struct SimplifyLimits {
  double deviation_m{};  ///< Of the surfaces, in both directions.
  double normal_deg{};   ///< Between the normal of a triangle and those of the ones it stands for.
};

/// Meshes with fewer triangles whose surfaces deviate by at most `limits`, one for each of `parts`,
/// which may share edges; they do so afterwards.
///
/// Edges are collapsed by OpenMesh in the order of the error quadrics of Garland and Heckbert
/// (1997), each only where the removed points stay near (ModHausdorffT) and the normals in their
/// cones (ModNormalDeviationT). Left as they are: triangles that OpenMesh cannot hold, as three
/// meet at an edge or two run about it the same way, and points where parts or such triangles meet,
/// and at borders.
/// The deviation is then measured apart from OpenMesh (MeshSurface), in both directions; what
/// deviates by more is made again with half the deviation, twice at most, and then left as it is.
[[nodiscard]] std::vector<Mesh> Simplified(const std::vector<Mesh>& parts,
                                           const SimplifyLimits& limits);

}  // namespace railcast
