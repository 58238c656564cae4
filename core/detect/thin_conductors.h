#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/detect/wire_set.h"
#include "core/trace/ray_tile.h"

namespace railcast {

/// What the beams of a tile have in common.
struct BeamShape {
  Eigen::Vector3f up_window;  ///< The sensor's z axis, unit length: up x direction is horizontal.
  /// Standard deviations of the profile: a quarter of the 1/e^2 full divergence. 0 = a ray.
  double sigma_horizontal_rad{};
  double sigma_vertical_rad{};
};

/// A piece of wire in a beam.
struct WireCapture {
  std::uint32_t lane{};     ///< The beam, in its tile.
  std::uint32_t surface{};  ///< Of the wire, in the window.
  float range_m{};          ///< As WireInBeam has it, like the rest.
  float share{};
  float spread_m{};
  float sin_axis{};
};

/// What a beam must at least meet of a segment for it to be noticed.
inline constexpr double kLeastWireShare = 1e-4;

/// Appends what every beam meets of every segment (core/detect/wire_in_beam.h says how), by lane,
/// then range, then surface. What stands in front is not looked at. A beam's captures depend on
/// that beam alone.
///
/// @param rays Their origins and directions.
void CaptureWires(const RayTile& rays,
                  const BeamShape& beam,
                  const WireSet& wires,
                  std::vector<WireCapture>& captures);

}  // namespace railcast
