#pragma once

namespace railcast {

/// How a train brakes for an obstacle on its track.
struct BrakingSpec {
  double reaction_s = 2.0;         ///< Time from the detection to full braking.
  double deceleration_mps2 = 0.5;  ///< Deceleration on level track.
  double margin_m = 15.0;          ///< Distance to be left before the object.
};

/// Distance and time that a train needs to stop.
struct BrakedStop {
  double distance_m{};  ///< Without the margin.
  double time_s{};
};

/// s = v t_r + v^2 / (2 (a + g i)), t = t_r + v / (a + g i); i is the gradient, rise per way,
/// negative downhill (constant deceleration; g = 9.80665 m/s2).
/// @throws InputError "cannot stop: rule (got value)" if a + g i <= 0.
[[nodiscard]] BrakedStop StopOf(const BrakingSpec& braking, double speed_mps, double gradient);

}  // namespace railcast
