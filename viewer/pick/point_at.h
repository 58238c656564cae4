#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>

namespace railcast {

/// Finds the point that a click on a picture means: of the points within 5 px the one nearest to
/// the eye, else the one nearest on the screen within 12 px. Points outside the clip volume,
/// including those behind the eye, are not visible and cannot be picked.
///
/// @param positions_m x, y, z of each point in turn. Points of NaN cannot be picked.
/// @param clip_from_points From homogeneous coordinates of the points to clip coordinates, where
///   the volume is -w <= x, y, z <= w with z = -w nearest to the eye.
/// @param size_px Width and height.
/// @param x_px, y_px The click, to the right and up from the lower left corner, as VTK counts.
[[nodiscard]] std::optional<std::size_t> PointAt(std::span<const float> positions_m,
                                                 const Eigen::Matrix4d& clip_from_points,
                                                 const std::array<int, 2>& size_px,
                                                 double x_px,
                                                 double y_px);

}  // namespace railcast
