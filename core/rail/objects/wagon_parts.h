#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "core/base/transform.h"
#include "core/scene/mesh.h"

namespace railcast {

/// The pieces wagons are put together from. Frame: x along the wagon, y left, z up from top of
/// rail; metres.

inline constexpr std::array<double, 2> kBothSides = {-1.0,
                                                     1.0};  ///< Right and left, or back and front.

/// A box between two corners.
[[nodiscard]] Mesh MakeBlock(const Vector3& min_m, const Vector3& max_m);

/// A box given for the left side, on the left (`side` 1) or mirrored to the right (-1).
[[nodiscard]] Mesh MakeSideBlock(double side, const Vector3& min_m, const Vector3& max_m);

/// A box given for the front end, at the front (`end` 1) or mirrored to the back (-1).
[[nodiscard]] Mesh MakeEndBlock(double end, const Vector3& min_m, const Vector3& max_m);

/// A bar: of eight sides, or square where it is thinner than 50 mm.
[[nodiscard]] Mesh MakeBar(const Vector3& begin_m, const Vector3& end_m, double radius_m);

/// A plate across y, from `begin_y_m` to `end_y_m`, over an outline of (x, z) points.
[[nodiscard]] Mesh MakePlate(std::span<const Eigen::Vector2d> outline,
                             double begin_y_m,
                             double end_y_m);

/// Shunter's steps at the four corners, (+-x, +-y), hung from `sill_z_m`.
[[nodiscard]] Mesh MakeCornerSteps(double x_m, double y_m, double sill_z_m);

/// Two longitudinal members in the middle, and the bolsters that rest on the bogies.
[[nodiscard]] Mesh MakeCentreSill(double half_length_m, double pivot_distance_m, double top_z_m);

/// Air reservoirs, brake cylinder and brake rod below the middle.
[[nodiscard]] Mesh MakeBrakeGear(double pivot_distance_m);

}  // namespace railcast
