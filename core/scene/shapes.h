#pragma once

#include <Eigen/Geometry>
#include <span>

#include "core/base/transform.h"
#include "core/scene/mesh.h"

namespace railcast {

/// Closed bodies as triangle meshes, wound so that normals point outwards. Round ones are polygons
/// whose corners lie on the true surface: a face lies inside it by radius (1 - cos(pi /
/// num_sides)).

/// @pre The box is not empty in any direction.
[[nodiscard]] Mesh MakeBox(const Eigen::AlignedBox3d& box);

/// A tube of constant radius around a line of at least two distinct points, capped at both ends and
/// mitred at bends: each straight piece is an exact prism of `num_sides` faces.
/// @pre Neighbouring points differ and the line turns by less than 150 degrees at each.
[[nodiscard]] Mesh MakeTube(std::span<const Vector3> centreline, double radius_m, int num_sides);

/// As above, with a radius at each point; between the points it changes linearly.
[[nodiscard]] Mesh MakeTube(std::span<const Vector3> centreline,
                            std::span<const double> radii_m,
                            int num_sides);

/// A body of revolution about the x axis. `profile` runs from end to end; each point is (x,
/// radius). Ends whose radius is not zero are capped. One corner of the section points along +y;
/// with `num_sides` a multiple of four corners also point along -y and +-z.
/// @pre At least two points, radii >= 0; x rising for normals to point outwards.
[[nodiscard]] Mesh MakeLathe(std::span<const Eigen::Vector2d> profile, int num_sides);

/// A prism along x, from `begin_x_m` to `end_x_m`, over a polygon of (y, z) points that is not
/// closed by a repeated point; convex or not, either turn.
[[nodiscard]] Mesh MakeExtrusion(std::span<const Eigen::Vector2d> outline,
                                 double begin_x_m,
                                 double end_x_m);

/// An ellipsoid with its half axes along x, y, z.
[[nodiscard]] Mesh MakeEllipsoid(const Vector3& centre_m,
                                 const Vector3& half_axes_m,
                                 int num_sides);

}  // namespace railcast
