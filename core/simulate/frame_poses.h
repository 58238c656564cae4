#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/base/transform.h"

namespace railcast {

/// A rigid pose in float32: rows of the rotation, then the translation.
struct PoseF {
  float r[9];
  float t[3];
};

/// The sensor's pose during one frame, so that every firing gets its own (rolling shutter).
///
/// Exact at knots 10 ms apart, linear between: an acceleration of 2 m/s^2 bends the path by
/// a dt^2 / 8 = 0.025 mm between knots, a turn of 0.1 rad/s the rotation by 1e-7.
class FramePoses {
 public:
  /// Stands still in the window's origin.
  FramePoses() : FramePoses(0, [](std::uint32_t) { return Transform::Identity(); }) {}
  /// @param window_from_sensor Pose at a time in nanoseconds since the stamp.
  FramePoses(std::uint32_t duration_ns,
             const std::function<Transform(std::uint32_t)>& window_from_sensor);

  /// The pose at `time_ns` since the stamp and, in `change_per_ns`, its slope there.
  [[nodiscard]] PoseF At(std::uint32_t time_ns, PoseF& change_per_ns) const;

  /// Times farther apart than this need a call of their own.
  [[nodiscard]] std::uint32_t knot_spacing_ns() const { return spacing_ns_; }

 private:
  std::uint32_t spacing_ns_;
  std::vector<PoseF> knots_;
};

}  // namespace railcast
