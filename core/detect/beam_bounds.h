#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "core/detect/wire_set.h"
#include "core/trace/ray_tile.h"

namespace railcast {

/// A chord between unit vectors that none exceeds.
inline constexpr float kAnyChord = 4.0F;

/// The beams of a packet as one cone from the middle of their origins. Angles are bounded by chords
/// between unit vectors, which add up like angles.
struct BeamCone {
  Eigen::Vector3f origin_m;
  Eigen::Vector3f direction;
  float spread_m{};  ///< The farthest of the origins from their middle, and slack for rounding.
  float chord{};     ///< From the middle direction to where a beam may capture something.
};

/// @param reach Chord to a beam's middle within which it captures something.
[[nodiscard]] BeamCone BoundPacket(const RayTile& rays, std::size_t first, float reach);

/// The beams of a tile as one pyramid of four planes: tiles may be long strips.
struct BeamPyramid {
  Eigen::Vector3f origin_m;
  Eigen::Vector3f direction;
  std::array<Eigen::Vector3f, 4> outward;  ///< Normals of the planes; 0 = no plane.
  float spread_m{};                        ///< As that of a cone.
};

[[nodiscard]] BeamPyramid BoundCones(const BeamCone* cones, std::size_t num_cones);

/// Whether beams may capture something in the ball.
[[nodiscard]] inline bool MayCapture(const BeamPyramid& beams, const WireBall& ball) {
  const Eigen::Vector3f center_m = ball.center_m - beams.origin_m;
  const float radius_m = ball.radius_m + beams.spread_m;
  return center_m.dot(beams.direction) >= -radius_m && center_m.dot(beams.outward[0]) <= radius_m &&
         center_m.dot(beams.outward[1]) <= radius_m && center_m.dot(beams.outward[2]) <= radius_m &&
         center_m.dot(beams.outward[3]) <= radius_m;
}

}  // namespace railcast
