#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

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

}  // namespace railcast
