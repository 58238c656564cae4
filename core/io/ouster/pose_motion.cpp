#include "core/io/ouster/pose_motion.h"

#include <algorithm>
#include <cstddef>

#include "core/base/units.h"

namespace railcast {
namespace {

constexpr double kGravity_mps2 = 9.80665;

}  // namespace

PoseMotion::PoseMotion(const Frame& frame, const Transform& sensor_from_imu) {
  knots_.push_back({frame.stamp_ns, frame.world_from_sensor * sensor_from_imu});
  for (const ScanPose& pose : frame.poses_between) {
    knots_.push_back({frame.stamp_ns + pose.time_ns, pose.world_from_sensor * sensor_from_imu});
  }
  if (frame.duration_ns == 0) return;
  knots_.push_back(
      {frame.stamp_ns + frame.duration_ns, frame.world_from_sensor_end * sensor_from_imu});
}

OusterImu PoseMotion::At(std::int64_t time_ns) const {
  const auto later = std::ranges::upper_bound(knots_, time_ns, {}, &Knot::time_ns);
  const auto place = static_cast<std::size_t>(later - knots_.begin());
  const std::size_t num_knots = knots_.size();
  // The interval in which the time lies, or the nearest one.
  const std::size_t end =
      std::clamp<std::size_t>(place, 1, std::max<std::size_t>(num_knots, 2) - 1);
  Eigen::Matrix3d world_from_imu = knots_.front().world_from_imu.linear();
  Vector3 rotation_radps = Vector3::Zero();
  Vector3 acceleration_mps2 = Vector3::Zero();
  if (num_knots >= 2) {
    const Knot& from = knots_[end - 1];
    const Knot& to = knots_[end];
    const double length_s = SecondsFromNs(to.time_ns - from.time_ns);
    const Eigen::AngleAxisd turn(from.world_from_imu.linear().transpose() *
                                 to.world_from_imu.linear());
    rotation_radps = turn.angle() / length_s * turn.axis();
    const double share = SecondsFromNs(time_ns - from.time_ns) / length_s;
    world_from_imu = from.world_from_imu.linear() *
                     Eigen::AngleAxisd(share * turn.angle(), turn.axis()).toRotationMatrix();
  }
  if (num_knots >= 3) {
    const std::size_t middle = std::min(end, num_knots - 2);
    const auto velocity = [&](std::size_t i) -> Vector3 {
      return (knots_[i].world_from_imu.translation() - knots_[i - 1].world_from_imu.translation()) /
             SecondsFromNs(knots_[i].time_ns - knots_[i - 1].time_ns);
    };
    const double length_s = SecondsFromNs(knots_[middle + 1].time_ns - knots_[middle - 1].time_ns);
    acceleration_mps2 = (velocity(middle + 1) - velocity(middle)) * (2.0 / length_s);
  }
  const Vector3 felt_g =
      world_from_imu.transpose() * (acceleration_mps2 / kGravity_mps2 + Vector3::UnitZ());
  OusterImu imu;
  for (int i = 0; i < 3; ++i) {
    imu.acceleration_g[static_cast<std::size_t>(i)] = static_cast<float>(felt_g[i]);
    imu.rotation_degps[static_cast<std::size_t>(i)] =
        static_cast<float>(DegFromRad(rotation_radps[i]));
  }
  return imu;
}

}  // namespace railcast
