#pragma once

#include <Eigen/Geometry>

namespace railcast {

/// Frames of reference, all right-handed, in metres and double precision:
/// - `world`: east, north, up.
/// - `track`: chainage s along the axis, lateral d (left positive), height h above top of rail.
/// - `vehicle`: x forward, y left, z up; origin on the track axis at top of rail below the first
///   axle.
/// - `sensor`: x forward, y left, z up; origin at the optical centre.
/// - `chunk`: one piece of the line; origin on the axis at its middle, x along the heading there, z
///   up (parallel to the world's).
/// - `window`: the chunk frame of the chunk the vehicle is in. Everything that is traced is
///   expressed in this frame, so that float32 coordinates stay close to the origin.
///
/// A transform is named `<to>_from_<from>`, so that adjacent names match in a product:
/// `world_from_sensor = world_from_vehicle * vehicle_from_sensor`.
using Vector3 = Eigen::Vector3d;
using Transform = Eigen::Isometry3d;

/// The rotation Rz(yaw) Ry(pitch) Rx(roll): first roll about x (positive: right side down), then
/// pitch about y (positive: nose down), then yaw about z (positive: to the left).
[[nodiscard]] inline Eigen::Matrix3d RotationFromYawPitchRoll(double yaw_rad,
                                                              double pitch_rad,
                                                              double roll_rad) {
  return (Eigen::AngleAxisd(yaw_rad, Vector3::UnitZ()) *
          Eigen::AngleAxisd(pitch_rad, Vector3::UnitY()) *
          Eigen::AngleAxisd(roll_rad, Vector3::UnitX()))
      .toRotationMatrix();
}

/// The transform that first rotates by `rotation` and then translates by `translation_m`.
[[nodiscard]] inline Transform MakeTransform(const Eigen::Matrix3d& rotation,
                                             const Vector3& translation_m) {
  Transform result = Transform::Identity();
  result.linear() = rotation;
  result.translation() = translation_m;
  return result;
}

}  // namespace railcast
