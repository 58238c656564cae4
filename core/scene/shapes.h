#pragma once

#include <Eigen/Geometry>
#include <span>

#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// Closed bodies as triangle meshes, wound so that normals point outwards. Round bodies are
/// polygonal with their corners on the true surface: faces lie inside it by up to radius (1 -
/// cos(pi / num_sides)).

/// @pre The box has a positive extent in every direction.
[[nodiscard]] Mesh MakeBox(const Eigen::AlignedBox3d& box);

/// A tube of constant radius along a polyline, capped at both ends and mitred at bends. Each
/// straight piece is an exact prism with `num_sides` faces.
/// @pre At least two points; neighbouring points differ, and the line turns by less than 150
///   degrees at each.
[[nodiscard]] Mesh MakeTube(std::span<const Vector3> centreline, double radius_m, int num_sides);

/// The overload with a radius for each point and linear interpolation in between.
[[nodiscard]] Mesh MakeTube(std::span<const Vector3> centreline,
                            std::span<const double> radii_m,
                            int num_sides);

/// A body of revolution about the x axis. The points of `profile` are (x, radius), from one end to
/// the other. Ends with a non-zero radius are capped. One corner of the cross-section points along
/// +y; if `num_sides` is a multiple of four, corners also point along -y and +-z.
/// @pre At least two points, radii >= 0; x increasing, so that normals point outwards.
[[nodiscard]] Mesh MakeLathe(std::span<const Eigen::Vector2d> profile, int num_sides);

/// A prism along x, from `begin_x_m` to `end_x_m`, over a polygon of (y, z) points. The first point
/// is not repeated at the end. The polygon may be convex or not and have either orientation.
[[nodiscard]] Mesh MakeExtrusion(std::span<const Eigen::Vector2d> outline,
                                 double begin_x_m,
                                 double end_x_m);

/// An ellipsoid with half axes along x, y, z.
[[nodiscard]] Mesh MakeEllipsoid(const Vector3& centre_m,
                                 const Vector3& half_axes_m,
                                 int num_sides);

}  // namespace railcast
