#include "core/c/host_motion.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/text.h"
#include "core/c/guard.h"

namespace railcast {
namespace {

// Engines keep rotations in float32, whose quaternions are of unit length to 1e-6.
constexpr double kUnitTolerance = 1e-3;
// float32 resolves 0.5 mm below this value, but only 1 mm or less above.
constexpr double kMillimetreReach_m = 8192.0;

Vector3 FiniteVector(const double (&values)[3], const std::string& name) {
  for (int i = 0; i < 3; ++i) {
    if (std::isfinite(values[i])) continue;
    throw ArgumentError(name + "[" + std::to_string(i) + "]: must be finite" + Got(values[i]));
  }
  return Eigen::Map<const Vector3>(values);
}

HostMotion::Pose PartsOf(const railcast_pose& pose, const std::string& place) {
  const Eigen::Quaterniond rotation(Eigen::Map<const Eigen::Vector4d>(pose.quaternion_xyzw));
  if (!(std::abs(rotation.norm() - 1.0) <= kUnitTolerance)) {
    throw ArgumentError(place + ".quaternion_xyzw: must be of unit length" + Got(rotation.norm()));
  }
  return {FiniteVector(pose.position_m, place + ".position_m"), rotation.normalized()};
}

}  // namespace

HostMotion::HostMotion(const railcast_motion& motion,
                       const FrameTime& time,
                       const Transform& vehicle_from_sensor)
    : begin_(PartsOf(motion.world_from_sensor, "motion.world_from_sensor")),
      end_(PartsOf(motion.world_from_sensor_end, "motion.world_from_sensor_end")),
      scene_origin_m_(FiniteVector(motion.scene_origin_m, "motion.scene_origin_m")),
      time_(time),
      sensor_from_vehicle_(vehicle_from_sensor.inverse()) {
  for (const Pose& pose : {begin_, end_}) {
    const double away_m = (pose.position_m - scene_origin_m_).cwiseAbs().maxCoeff();
    if (away_m <= kMillimetreReach_m) continue;
    throw ArgumentError(
        "motion.scene_origin_m: must lie within 8192 m of the sensor, since float32 loses "
        "millimetres beyond" +
        Got(away_m));
  }
}

Transform HostMotion::window_from_world() const {
  return MakeTransform(Eigen::Matrix3d::Identity(), -scene_origin_m_);
}

Transform HostMotion::WorldFromVehicle(std::int64_t time_ns) const {
  const double duration_ns = std::max(1.0, static_cast<double>(time_.duration_ns));
  const double share = static_cast<double>(time_ns - time_.stamp_ns) / duration_ns;
  const Vector3 position_m = begin_.position_m + share * (end_.position_m - begin_.position_m);
  const Eigen::Quaterniond rotation = begin_.rotation.slerp(share, end_.rotation);
  return MakeTransform(rotation.toRotationMatrix(), position_m) * sensor_from_vehicle_;
}

railcast_pose PoseOf(const Transform& transform) {
  Eigen::Quaterniond rotation(transform.linear());
  if (rotation.w() < 0.0) rotation.coeffs() *= -1.0;
  railcast_pose pose{};
  Eigen::Map<Vector3>(pose.position_m) = transform.translation();
  Eigen::Map<Eigen::Vector4d>(pose.quaternion_xyzw) = rotation.coeffs();
  return pose;
}

}  // namespace railcast
