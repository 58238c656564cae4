#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// Closed bodies from which the bodies of rail vehicles are composed. Frame: x along the vehicle, y
/// left, z up from top of rail; metres.

/// The corners of a cross-section at one place along the vehicle.
using VehicleSection = std::vector<Vector3>;

/// The cross-section with that left half, whose points (y, z) lead from the lower edge to the top;
/// y >= 0.
[[nodiscard]] VehicleSection MakeVehicleSection(double x_m,
                                                std::span<const Eigen::Vector2d> left_half);

/// The body that leads straight from one cross-section to the next.
/// @pre At least two sections with equally many corners in the same order. The first and the last
///   are star-shaped about the mean of their corners.
[[nodiscard]] Mesh MakeLoft(std::span<const VehicleSection> sections);

/// A part of a face with four corners: from 0 to 1 along its first and its last edge (`u`), and
/// from one to the other (`v`).
struct FacePart {
  double begin_u = 0.0;
  double end_u = 1.0;
  double begin_v = 0.0;
  double end_v = 1.0;
};

/// A plate on a face, such as a pane of glass glued onto a body: it covers `part` of it, stands out
/// by `proud_m` and reaches 3 cm inwards. The corners go round, and `outwards` is on the outer
/// side.
[[nodiscard]] Mesh MakePane(const std::array<Vector3, 4>& corners_m,
                            const FacePart& part,
                            const Vector3& outwards,
                            double proud_m);

/// The face between corner `index` of two sections and the next corner: its first edge is that of
/// `a`.
[[nodiscard]] std::array<Vector3, 4> FaceBetween(const VehicleSection& a,
                                                 const VehicleSection& b,
                                                 std::size_t index);

}  // namespace railcast
