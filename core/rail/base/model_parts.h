#pragma once

#include "core/rail/base/rail_surfaces.h"
#include "railcast/scene.h"

namespace railcast {

/// Returns the model's part with that surface; adds the part if there is none yet. The reference is
/// valid until the next part is added.
[[nodiscard]] Part& PartOf(const SurfaceClass& surface, Model& model);
[[nodiscard]] inline Mesh& MeshOf(const SurfaceClass& surface, Model& model) {
  return PartOf(surface, model).mesh;
}

}  // namespace railcast
