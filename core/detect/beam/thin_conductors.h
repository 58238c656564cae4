#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/detect/beam/wire_in_beam.h"
#include "core/detect/beam/wire_set.h"
#include "railcast/ray_caster.h"

namespace railcast {

/// Orientation and width of the beams of a tile.
struct BeamShape {
  Eigen::Vector3f up_window;  ///< The sensor's unit z axis: up x direction is horizontal.
  /// Standard deviations of the profile: a quarter of the 1/e^2 full divergence. 0 = a ray.
  double sigma_horizontal_rad{};
  double sigma_vertical_rad{};
};

/// A piece of wire in a beam. Range, share, spread and sine are those of WireInBeam.
struct WireCapture {
  std::uint32_t lane{};     ///< Lane of the beam in its tile.
  std::uint32_t surface{};  ///< Index of the wire's surface in the window.
  float range_m{};
  float share{};
  float spread_m{};
  float sin_axis{};
  WireStrip strip{};
  Eigen::Vector3f axis = Eigen::Vector3f::Zero();  ///< Unit vector along the wire.
};

/// The share of a capture that nearer captures of the same beam hide, in [0, 1]. Along the track a
/// contact wire hides the droppers above it completely, although it fills little of the beam.
/// @param nearer The captures in front of it.
[[nodiscard]] float HiddenShare(const WireCapture& capture, std::span<const WireCapture> nearer);

/// Least share of a beam on a segment; captures with less are dropped.
inline constexpr double kLeastWireShare = 1e-4;

/// Appends the captures of all segments by all beams (core/detect/beam/wire_in_beam.h), sorted by
/// lane, then range, then surface. Surfaces in front of a wire are not taken into account. A beam's
/// captures depend on that beam alone.
///
/// @param rays The beams; only origins and directions are read, and the shutter where wires move.
void CaptureWires(const RayTile& rays,
                  const BeamShape& beam,
                  const WireSet& wires,
                  std::vector<WireCapture>& captures);

}  // namespace railcast
