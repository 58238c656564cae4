#pragma once

#include <optional>
#include <vector>

#include "railcast/world_spec.h"

namespace railcast {

struct Suspension;

/// Chainage and speed of an object on a track as functions of time, in closed form.
///
/// Acceleration is constant between the points of the profile. Before the first and after the last
/// point, speed is constant: a first point at 5 s, or 300 m ahead, is approached at its own speed.
class SpeedProfile {
 public:
  struct State {
    double s_m{};
    double speed_mps{};  ///< >= 0, also in reverse.
    /// In the direction of travel. Where it changes, that which begins.
    double acceleration_mps2{};
    double speeding_up_m{};   ///< Travelled since time 0 while the speed rose.
    double slowing_down_m{};  ///< Travelled since time 0 while the speed fell.
  };

  /// @param start_s_m Chainage at time 0.
  /// @throws InputError if the points are not all in time or all in chainage, do not advance in the
  ///   direction of travel, have a negative speed, or specify a chainage that is never reached.
  ///   Lines read "/profile/2/s_m: rule (got value)", relative to the motion's JSON object.
  SpeedProfile(const MotionSpec& motion, double start_s_m);

  /// Returns the same motion up to `time_s` and then a change to another speed, which is approached
  /// at a constant acceleration and then kept. The direction stays the same.
  ///
  /// The result is valid from `time_s` on only: earlier points are dropped, so that a profile that
  /// is changed repeatedly does not grow.
  /// @pre time_s >= 0, speed_mps >= 0, acceleration_mps2 > 0 (also for slowing down).
  [[nodiscard]] SpeedProfile WithSpeedFrom(double time_s,
                                           double speed_mps,
                                           double acceleration_mps2) const;

  /// Before time 0 and before the last change, the motion that begins there is continued backwards.
  [[nodiscard]] State At(double time_s) const;
  /// The acceleration as something on a spring and a damper follows it, which a constant one has
  /// settled long ago.
  /// @param after_s Then instead, if the stretch of constant acceleration that `time_s` is in goes
  ///   on.
  [[nodiscard]] double SprungAcceleration_mps2(const Suspension& suspension,
                                               double time_s,
                                               double after_s = 0.0) const;
  /// When the chainage is reached for the first time; absent if it lies behind or is never reached.
  /// The time is not before that of the last change.
  [[nodiscard]] std::optional<double> TimeAt_s(double s_m) const;
  /// Whether the chainage ever changes.
  [[nodiscard]] bool moves() const;
  [[nodiscard]] bool reverse() const { return direction_ < 0.0; }

 private:
  struct Corner {
    double time_s{};
    double travelled_m{};
    double speed_mps{};
    double acceleration_mps2{};  ///< Constant up to the next corner.
    double speeding_up_m{};      ///< The part of travelled_m with rising speed.
    double slowing_down_m{};     ///< The part of travelled_m with falling speed.

    /// Sets the last two: what was travelled since the corner before counts by its acceleration.
    void CountDistancesSince(const Corner& before);
  };

  /// A sudden change of the acceleration.
  struct Jolt {
    double time_s{};
    double change_mps2{};
  };
  /// The jolts up to `time_s` whose effect on a suspension has not died away.
  [[nodiscard]] std::vector<Jolt> RecentJolts(double time_s) const;

  std::vector<Corner> corners_;  ///< The first is at time 0.
  std::vector<Jolt> dropped_;  ///< Jolts of corners that were dropped, and that of the last change.
  double start_s_m_{};
  double direction_ = 1.0;
};

}  // namespace railcast
