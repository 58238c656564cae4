#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace railcast {

/// Cuts a plane polygon, convex or not, into triangles of indices into `outline` by clipping ears
/// (Meisters 1975, "Polygons have ears"). Triangles turn the way the outline does and have an
/// area; there are two fewer than corners, less one for each that repeats its neighbour. A polygon
/// that crosses itself has no proper cut: it gets one that may overlap.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> TriangulatePolygon(
    std::span<const Eigen::Vector2d> outline);

}  // namespace railcast
