#pragma once

#include <vector>

#include "core/rail/line/motion_spec.h"

namespace railcast {

/// Chainage and speed of something that moves along a track, as functions of time in closed form.
///
/// Acceleration is constant between the points of the profile. After the last point, and before the
/// first, speed is constant: a first point at 5 s or 300 m ahead is reached at its own speed.
class SpeedProfile {
 public:
  struct State {
    double s_m{};
    double speed_mps{};  ///< >= 0, also in reverse.
  };

  /// @param start_s_m Chainage at time 0.
  /// @throws InputError if the points are not all in time or all in chainage, do not go on in the
  ///   direction of travel, have a negative speed, or name a chainage that is never reached. Lines
  ///   read "/profile/2/s_m: rule (got value)", relative to the motion's JSON object.
  SpeedProfile(const MotionSpec& motion, double start_s_m);

  /// The same way up to `time_s`, and from then on another speed: approached at a constant
  /// acceleration, then kept, in the same direction.
  ///
  /// It is for times from `time_s` on: what was before is left out, so that a profile which is
  /// changed again and again does not grow.
  /// @pre time_s >= 0, speed_mps >= 0, acceleration_mps2 > 0 (also to slow down).
  [[nodiscard]] SpeedProfile WithSpeedFrom(double time_s,
                                           double speed_mps,
                                           double acceleration_mps2) const;

  /// @pre time_s >= 0, and not before that of the last change.
  [[nodiscard]] State At(double time_s) const;
  /// Whether it ever leaves its place.
  [[nodiscard]] bool moves() const;
  [[nodiscard]] bool reverse() const { return direction_ < 0.0; }

 private:
  struct Corner {
    double time_s{};
    double travelled_m{};
    double speed_mps{};
    double acceleration_mps2{};  ///< To the next corner.
  };

  std::vector<Corner> corners_;  ///< The first at time 0.
  double start_s_m_{};
  double direction_ = 1.0;
};

}  // namespace railcast
