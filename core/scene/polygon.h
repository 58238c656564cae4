#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace railcast {

/// Triangulates a polygon, convex or not, by ear clipping (Meisters 1975, "Polygons have ears").
/// Triangles are indices into `outline`; there are two fewer than corners. Some have no area if
/// corners are collinear or repeated; the others have the orientation of the outline. A polygon
/// that intersects itself has no proper triangulation and gets one that may overlap.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> ClipEars(
    std::span<const Eigen::Vector2d> outline);

/// Twice the area that rounding of coordinates can produce in a polygon without area. `extent` is
/// the maximum distance of a corner from the first.
[[nodiscard]] double TwiceFlatArea(double extent);

/// As ClipEars(), but without triangles that have no area.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> TriangulatePolygon(
    std::span<const Eigen::Vector2d> outline);

}  // namespace railcast
