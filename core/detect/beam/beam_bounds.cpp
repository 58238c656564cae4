#include "core/detect/beam/thin_conductors.h"

#include <algorithm>
#include <cmath>

#include "railcast/lidar.h"

namespace railcast {
namespace {

constexpr float kSlack_m = 1e-3F;  // Rounding of coordinates up to 1 km is below 1e-4 m.
constexpr float kEverywhere_m = 1e6F;
constexpr float kWideChord = 0.5F;  // Wider bundles are not bounded: a bound would reject little.

}  // namespace

BeamCone BoundPacket(const RayTile& rays, std::size_t first, float reach) {
  const auto origin_m = [&](std::size_t i) {
    return Eigen::Vector3f(rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]);
  };
  const auto direction = [&](std::size_t i) {
    return Eigen::Vector3f(rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]);
  };
  Eigen::Vector3f origins = Eigen::Vector3f::Zero();
  Eigen::Vector3f directions = Eigen::Vector3f::Zero();
  for (std::size_t i = first; i < first + kPacketSize; ++i) {
    origins += origin_m(i);
    directions += direction(i);
  }
  BeamCone cone;
  cone.origin_m = origins / static_cast<float>(kPacketSize);
  cone.direction = directions.normalized();
  float origin_square = 0.0F;
  float direction_square = 0.0F;
  for (std::size_t i = first; i < first + kPacketSize; ++i) {
    origin_square = std::max(origin_square, (origin_m(i) - cone.origin_m).squaredNorm());
    direction_square = std::max(direction_square, (direction(i) - cone.direction).squaredNorm());
  }
  cone.spread_m = std::sqrt(origin_square) + kSlack_m;
  cone.chord = std::sqrt(direction_square) + reach;
  if (!(cone.chord < kWideChord)) cone.chord = kAnyChord;
  return cone;
}

BeamPyramid BoundCones(const BeamCone* cones, std::size_t num_cones) {
  Eigen::Vector3f origins = Eigen::Vector3f::Zero();
  Eigen::Vector3f directions = Eigen::Vector3f::Zero();
  for (std::size_t i = 0; i < num_cones; ++i) {
    origins += cones[i].origin_m;
    directions += cones[i].direction;
  }
  BeamPyramid beams;
  beams.origin_m = origins / static_cast<float>(num_cones);
  beams.direction = directions.normalized();
  beams.spread_m = 0.0F;
  for (Eigen::Vector3f& normal : beams.outward) normal.setZero();

  float widest = 0.0F;
  Eigen::Vector3f farthest = Eigen::Vector3f::Zero();
  for (std::size_t i = 0; i < num_cones; ++i) {
    const BeamCone& cone = cones[i];
    const float apart_m = (cone.origin_m - beams.origin_m).norm();
    beams.spread_m = std::max(beams.spread_m, apart_m + cone.spread_m);
    const Eigen::Vector3f aside = cone.direction - beams.direction;
    if (aside.squaredNorm() > farthest.squaredNorm()) farthest = aside;
    widest = std::max(widest, aside.norm() + cone.chord);
  }
  if (!(widest < kWideChord)) {
    beams.spread_m = kEverywhere_m;
    return beams;
  }
  // The planes bound the tangents of angles from the middle, along the strip and across it.
  const Eigen::Vector3f across = beams.direction.cross(farthest);
  const Eigen::Vector3f side =
      across.norm() > 1e-6F ? across.normalized() : beams.direction.unitOrthogonal();
  const Eigen::Vector3f axes[2] = {side, side.cross(beams.direction)};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    float min = 0.0F;
    float max = 0.0F;
    for (std::size_t i = 0; i < num_cones; ++i) {
      const float depth = cones[i].direction.dot(beams.direction);
      const float tangent = cones[i].direction.dot(axes[axis]) / depth;
      // Here a chord is at least 0.96 times its angle, and the tangent of an angle up to 0.5 rad
      // grows by less than 1 / cos^2(0.5) = 1.3 per rad.
      const float reach = 1.4F * cones[i].chord;
      min = std::min(min, tangent - reach);
      max = std::max(max, tangent + reach);
    }
    beams.outward[2 * axis] = (axes[axis] - max * beams.direction).normalized();
    beams.outward[2 * axis + 1] = (min * beams.direction - axes[axis]).normalized();
  }
  return beams;
}

}  // namespace railcast
