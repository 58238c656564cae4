#pragma once

#include "railcast/scene.h"

namespace railcast {

/// A mesh as dense as a scan: each triangle is cut in four `num_times` in succession, at the
/// middles of its edges.
[[nodiscard]] Mesh Subdivided(const Mesh& mesh, int num_times);

/// Displaces every vertex along its normal by noise of this standard deviation, as a scanner that
/// the mesh is from would. Vertices in one place stay together.
void AddNoise(double sigma_m, Mesh& mesh);

}  // namespace railcast
