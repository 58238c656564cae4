#pragma once

#include <cstddef>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "railcast/scene.h"

namespace railcast {

/// The vertices of the model's part with that surface; empty if it has none.
[[nodiscard]] std::vector<Vector3> VerticesOf(const Model& model, const SurfaceClass& surface);

/// Length of the longest edge of every triangle with that surface.
[[nodiscard]] std::vector<double> LongestEdges_m(const Model& model, const SurfaceClass& surface);

/// Number of triangles with an index out of range, a non-finite coordinate, or no area.
[[nodiscard]] std::size_t CountBadTriangles(const Model& model);

/// Number of edges at which the surface of the model is open, or its triangles turn to different
/// sides: those that do not belong to as many triangles in the one direction as in the other. The
/// parts may share edges.
[[nodiscard]] std::size_t CountOpenEdges(const Model& model);
[[nodiscard]] std::size_t CountOpenEdges(const Mesh& mesh);

/// Expects bitwise equal ground and models, with the same placements and instances.
void ExpectSameChunk(const Chunk& first, const Chunk& second);

}  // namespace railcast
