#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// A closed line around a body: one of its cross-sections. Points may coincide.
using Rib = std::vector<Vector3>;

/// The closed body through ribs with the same number of points, its ends closed by fans about their
/// middles. Normals point outwards, whichever way the ribs turn. `is_endless` joins the last rib to
/// the first one instead, as in a tyre.
/// @pre At least two ribs of at least three points.
[[nodiscard]] Mesh MakeLoftedBody(std::span<const Rib> ribs, bool is_endless = false);

/// What the surface of a lofted body is made of.
struct BodySurfaces {
  /// That between the ribs `piece` and `piece` + 1, and between the points `side` and `side` + 1.
  std::function<SurfaceClass(std::size_t piece, std::size_t side)> wall;
  SurfaceClass first_end, last_end;
};

/// Adds a body like MakeLoftedBody(), whose panels are of several surfaces.
void AddLoftedBody(std::span<const Rib> ribs, const BodySurfaces& surfaces, Model& model);

/// A smooth curve through points (x, value) with rising x: piecewise cubic, without overshoot
/// (Fritsch and Carlson 1980, "Monotone piecewise cubic interpolation"). Constant beyond its ends.
[[nodiscard]] double SmoothValueAt(std::span<const Eigen::Vector2d> points, double x);

/// The rib at `x_m` of a body that is its own mirror image: `half` are points (y, z) from the
/// middle of the bottom to that of the top, of which the first and the last have y = 0.
[[nodiscard]] Rib MirroredRib(double x_m, std::span<const Eigen::Vector2d> half);
/// The panel of the left half that a side of a MirroredRib() is or mirrors, from 0 at the bottom.
[[nodiscard]] std::size_t HalfPanel(std::size_t side, std::size_t num_half_points);

/// An oval cross-section of a body that is bent in a plane of constant y.
struct OvalSection {
  double x_m{};
  double z_m{};
  double half_height_m{};  ///< In the plane, across the body's axis.
  double half_width_m{};   ///< Along y.
};
/// A closed body through ovals, smooth along its axis (Catmull and Rom 1974) and rounded at both
/// ends. `y_m` is that of the axis at its first and at its last section.
[[nodiscard]] Mesh MakeOvalBody(std::span<const OvalSection> sections,
                                const Eigen::Vector2d& y_m,
                                int num_sides);

/// The body that a closed outline of points (y, radius) sweeps about the y axis.
[[nodiscard]] Mesh MakeRevolvedBody(std::span<const Eigen::Vector2d> outline, int num_sides);

/// Moves the middle of the model's footprint to the origin, and its lowest point to z = 0.
void StandOnOrigin(Model& model);
/// Stretches the model along its axes to exactly `size_m`, and stands it on its origin.
void ScaleTo(const Vector3& size_m, Model& model);

}  // namespace railcast
