#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "railcast/transform.h"

namespace railcast {

/// A rigid pose in float32: rows of the rotation, then the translation.
struct PoseF {
  float r[9];
  float t[3];
};

/// The sensor's pose during one frame, evaluated for each firing (rolling shutter).
///
/// Poses are exact at knots 10 ms apart and linear in between. Between knots, an acceleration of 2
/// m/s^2 bends the path by a dt^2 / 8 = 0.025 mm, and a rotation rate of 0.1 rad/s changes the
/// rotation by 1e-7 more than linearly.
class FramePoses {
 public:
  /// A stationary sensor at the window's origin.
  FramePoses() : FramePoses(0, [](std::uint32_t) { return Transform::Identity(); }) {}
  /// @param window_from_sensor Pose at a time in nanoseconds since the stamp.
  FramePoses(std::uint32_t duration_ns,
             const std::function<Transform(std::uint32_t)>& window_from_sensor);

  /// Returns the pose at `time_ns` since the stamp and stores its rate of change there in
  /// `change_per_ns`.
  [[nodiscard]] PoseF At(std::uint32_t time_ns, PoseF& change_per_ns) const;

  /// The rate of change is valid for at most this long; later times need another call of At().
  [[nodiscard]] std::uint32_t knot_spacing_ns() const { return spacing_ns_; }

 private:
  std::uint32_t spacing_ns_;
  std::vector<PoseF> knots_;
};

}  // namespace railcast
