#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace railcast {

/// Cuts a polygon, convex or not, into triangles of indices into `outline` by clipping ears
/// (Meisters 1975, "Polygons have ears"): two fewer than corners, some of them without an area
/// where corners lie on a straight line or repeat. The others turn the way the outline does. A
/// polygon that crosses itself has no proper cut: it gets one that may overlap.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> ClipEars(
    std::span<const Eigen::Vector2d> outline);

/// Twice the area that the rounding of coordinates can feign in a polygon so large: `extent` is the
/// greatest distance of a corner from the first.
[[nodiscard]] double TwiceFlatArea(double extent);

/// As ClipEars(), without triangles that have no area.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> TriangulatePolygon(
    std::span<const Eigen::Vector2d> outline);

}  // namespace railcast
