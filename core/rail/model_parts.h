#pragma once

#include "core/rail/rail_surfaces.h"
#include "core/scene/mesh.h"

namespace railcast {

/// The model's part of that surface, which is added where there is none yet.
/// The reference holds until the next part is added.
[[nodiscard]] Part& PartOf(const SurfaceClass& surface, Model& model);
[[nodiscard]] inline Mesh& MeshOf(const SurfaceClass& surface, Model& model) {
  return PartOf(surface, model).mesh;
}

}  // namespace railcast
