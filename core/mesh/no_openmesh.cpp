#include "core/base/error.h"
#include "core/mesh/simplify.h"

namespace railcast {

Mesh CollapseEdges(const Mesh& /*mesh*/,
                   const std::vector<bool>& /*is_held*/,
                   const SimplifyLimits& /*limits*/) {
  throw InputError(
      "this build of railcast has no OpenMesh and simplifies no mesh: tolerance_mm must be 0");
}

}  // namespace railcast
