#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/detect/beam/wire_in_beam.h"
#include "core/detect/beam/wire_set.h"
#include "railcast/ray_caster.h"

namespace railcast {

/// A chord longer than any chord between unit vectors, which is at most 2.
inline constexpr float kAnyChord = 4.0F;

/// A cone that contains the beams of a packet. Its apex is the mean of their origins. Angles are
/// bounded by chords between unit vectors, which obey the triangle inequality as angles do.
struct BeamCone {
  Eigen::Vector3f origin_m;
  Eigen::Vector3f direction;
  float spread_m{};  ///< Largest distance of an origin from origin_m, plus slack for rounding.
  float chord{};     ///< Largest chord from `direction` to a direction that a beam may capture.
};

/// Bounds the packet that begins at lane `first`.
/// @param reach Chord from a beam's axis within which it captures something.
[[nodiscard]] BeamCone BoundPacket(const RayTile& rays, std::size_t first, float reach);

/// A pyramid of four planes that contains the beams of a tile. A cone would be too wide, since a
/// tile may be a long strip.
struct BeamPyramid {
  Eigen::Vector3f origin_m;
  Eigen::Vector3f direction;
  std::array<Eigen::Vector3f, 4> outward;  ///< Outward normals of the planes; 0 = no plane.
  float spread_m{};                        ///< Radius around origin_m that contains all origins.
};

/// Bounds all cones of a tile by one pyramid.
[[nodiscard]] BeamPyramid BoundCones(const BeamCone* cones, std::size_t num_cones);

/// Whether one of the beams may capture something in the ball.
[[nodiscard]] inline bool MayCapture(const BeamPyramid& beams, const WireBall& ball) {
  const Eigen::Vector3f center_m = ball.center_m - beams.origin_m;
  const float radius_m = ball.radius_m + beams.spread_m;
  return center_m.dot(beams.direction) >= -radius_m && center_m.dot(beams.outward[0]) <= radius_m &&
         center_m.dot(beams.outward[1]) <= radius_m && center_m.dot(beams.outward[2]) <= radius_m &&
         center_m.dot(beams.outward[3]) <= radius_m;
}

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
