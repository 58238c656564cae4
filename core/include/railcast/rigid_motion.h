#pragma once

#include "railcast/transform.h"

namespace railcast {

/// Pose and motion of a rigid body at an instant. Velocities and accelerations are in world axes.
struct RigidMotion {
  Transform world_from_body = Transform::Identity();
  Vector3 velocity_mps = Vector3::Zero();       ///< Velocity of the body's origin.
  Vector3 acceleration_mps2 = Vector3::Zero();  ///< Acceleration of the body's origin.
  Vector3 angular_velocity_radps = Vector3::Zero();
  Vector3 angular_acceleration_radps2 = Vector3::Zero();

  /// Velocity of a point of the body.
  /// @param point_m In the body's frame.
  [[nodiscard]] Vector3 VelocityOf_mps(const Vector3& point_m) const {
    const Vector3 arm_m = world_from_body.linear() * point_m;
    return velocity_mps + angular_velocity_radps.cross(arm_m);
  }
  /// Acceleration of a point: that of the body's origin plus the tangential and centripetal ones.
  /// @param point_m In the body's frame.
  [[nodiscard]] Vector3 AccelerationOf_mps2(const Vector3& point_m) const {
    const Vector3 arm_m = world_from_body.linear() * point_m;
    return acceleration_mps2 + angular_acceleration_radps2.cross(arm_m) +
           angular_velocity_radps.cross(angular_velocity_radps.cross(arm_m));
  }
};

}  // namespace railcast
