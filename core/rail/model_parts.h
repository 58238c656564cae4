#pragma once

#include "core/rail/rail_surfaces.h"
#include "core/scene/mesh.h"

namespace railcast {

/// The mesh of the model's part of that surface, which is added where there is none yet.
/// The reference holds until the next part is added.
[[nodiscard]] Mesh& MeshOf(const SurfaceClass& surface, Model& model);

}  // namespace railcast
