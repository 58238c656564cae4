#include "core/rail/motion/differentiated.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace railcast {
namespace {

/// A quantity at -2, -1, 0, 1 and 2 differences from the instant.
using FiveVectors = std::array<Vector3, 5>;

Vector3 FirstDerivative(const FiveVectors& at) {
  return (at[0] - at[4] + 8.0 * (at[3] - at[1])) / (12.0 * kDifference_s);
}

Vector3 SecondDerivative(const FiveVectors& at) {
  return (16.0 * (at[1] + at[3]) - at[0] - at[4] - 30.0 * at[2]) /
         (12.0 * kDifference_s * kDifference_s);
}

/// Axis times angle of a small rotation. Unlike Eigen's, it loses no digits near none.
Vector3 SmallRotation_rad(const Eigen::Matrix3d& turn) {
  const Vector3 sine(0.5 * (turn(2, 1) - turn(1, 2)), 0.5 * (turn(0, 2) - turn(2, 0)),
                     0.5 * (turn(1, 0) - turn(0, 1)));
  const double sine_of_angle = sine.norm();
  if (sine_of_angle == 0.0) return sine;
  const double angle_rad = std::atan2(sine_of_angle, 0.5 * (turn.trace() - 1.0));
  return angle_rad / sine_of_angle * sine;
}

}  // namespace

RigidMotion Differentiated(const std::function<Transform(double after_s)>& world_from_body_after) {
  RigidMotion motion;
  motion.world_from_body = world_from_body_after(0.0);
  const Vector3 origin_m = motion.world_from_body.translation();
  const Eigen::Matrix3d body_from_world = motion.world_from_body.linear().transpose();
  FiveVectors places_m;
  // Rotations since the instant, in world axes. At none, the first derivative of axis times angle
  // is the angular velocity, and the second one the angular acceleration.
  FiveVectors turns_rad;
  for (std::size_t i = 0; i < places_m.size(); ++i) {
    const double after_s = (static_cast<double>(i) - 2.0) * kDifference_s;
    const Transform there = i == 2 ? motion.world_from_body : world_from_body_after(after_s);
    places_m[i] = there.translation() - origin_m;
    turns_rad[i] = i == 2 ? Vector3::Zero() : SmallRotation_rad(there.linear() * body_from_world);
  }
  motion.velocity_mps = FirstDerivative(places_m);
  motion.acceleration_mps2 = SecondDerivative(places_m);
  motion.angular_velocity_radps = FirstDerivative(turns_rad);
  motion.angular_acceleration_radps2 = SecondDerivative(turns_rad);
  return motion;
}

RigidMotion MotionOnTrack(
    const TrackPath& path,
    std::int64_t time_ns,
    const std::function<Transform(double s_m, double speed_mps)>& world_from_body_at) {
  const SpeedProfile::State now = path.StateAt(time_ns);
  const double direction = path.reverse() ? -1.0 : 1.0;
  return Differentiated([&](double after_s) {
    const double later_mps = now.speed_mps + now.acceleration_mps2 * after_s;
    const double ahead_m = 0.5 * (now.speed_mps + later_mps) * after_s;
    return world_from_body_at(now.s_m + direction * ahead_m, later_mps);
  });
}

}  // namespace railcast
