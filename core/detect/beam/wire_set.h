#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "railcast/transform.h"

namespace railcast {

/// A straight piece of a wire, round in section, in the window frame.
struct WireSegment {
  Eigen::Vector3f begin_m;
  Eigen::Vector3f end_m;
  float radius_m{};
  std::uint32_t surface{};  ///< Index into the window's surfaces.
  /// How far either end moves from shutter 0 to shutter 1.
  Eigen::Vector3f begin_move_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f end_move_m = Eigen::Vector3f::Zero();
  float travel_m = 0.0F;  ///< The greater of these two distances; 0 = it hangs still.
};

/// Where a segment is at a time of the shutter. Its `travel_m` is 0.
[[nodiscard]] inline WireSegment SegmentAt(const WireSegment& wire, float shutter) {
  return {.begin_m = wire.begin_m + shutter * wire.begin_move_m,
          .end_m = wire.end_m + shutter * wire.end_move_m,
          .radius_m = wire.radius_m,
          .surface = wire.surface};
}

/// A ball that contains wires, including their radii, at all times of the shutter.
struct WireBall {
  Eigen::Vector3f center_m;
  float radius_m{};
};

/// Consecutive segments and a ball that contains them, so that most beams can skip them all at
/// once.
struct WireGroup {
  WireBall ball;
  std::uint32_t first_segment{};
  std::uint32_t end_segment{};
};

/// The thin conductors of a window.
struct WireSet {
  std::vector<WireSegment> segments;
  std::vector<WireBall> balls;  ///< A ball around each segment.
  std::vector<WireGroup> groups;

  /// Adds a polyline of at least two points in the window frame.
  /// @param moves_m How far each point moves from shutter 0 to shutter 1; empty = none does.
  void Add(const std::vector<Vector3>& points_m,
           double radius_m,
           std::uint32_t surface,
           const std::vector<Vector3>& moves_m = {});
};

}  // namespace railcast
