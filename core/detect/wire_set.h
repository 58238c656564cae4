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
};

/// A ball that contains wires, including their radii.
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
  void Add(const std::vector<Vector3>& points_m, double radius_m, std::uint32_t surface);
};

}  // namespace railcast
