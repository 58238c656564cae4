#pragma once

#include <cstddef>
#include <vector>

#include "core/rail/rail_surfaces.h"
#include "core/scene/mesh.h"
#include "core/scene/world.h"

namespace railcast {

/// The vertices of a model's part of that surface; empty if it has none.
[[nodiscard]] std::vector<Vector3> VerticesOf(const Model& model, const SurfaceClass& surface);

/// The longest edge of every triangle of that surface.
[[nodiscard]] std::vector<double> LongestEdges_m(const Model& model, const SurfaceClass& surface);

/// Triangles with an index out of range, a coordinate that is no number, or no area.
[[nodiscard]] std::size_t CountBadTriangles(const Model& model);

/// Expects the same bytes of ground and models, in the same places with the same instances.
void ExpectSameChunk(const Chunk& first, const Chunk& second);

}  // namespace railcast
