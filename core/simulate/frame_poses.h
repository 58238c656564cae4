#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "railcast/frame.h"
#include "railcast/transform.h"

namespace railcast {

/// A rigid pose in float32: rows of the rotation, then the translation.
struct PoseF {
  float r[9];
  float t[3];
};

/// The sensor's poses between the first and the last firing of a frame, as they are recorded:
/// evenly spaced by at most 20 ms. Linear interpolation is then wrong by a dt^2 / 8 = 0.2 mm in an
/// arc of 300 m at 120 km/h, and by 0.8 mm at 50 m from the sensor where a turnout of 190 m is
/// passed at 80 km/h, twice its speed.
[[nodiscard]] std::vector<ScanPose> PosesBetween(
    std::uint32_t duration_ns, const std::function<Transform(std::uint32_t)>& world_from_sensor);

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
