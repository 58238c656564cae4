#pragma once

#include <memory>
#include <vector>

#include "core/mesh/edge_collapse.h"
#include "railcast/scene.h"

namespace railcast {

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
