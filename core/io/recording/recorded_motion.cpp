#include "core/io/recording/recorded_motion.h"

#include "core/base/units.h"

namespace railcast {
namespace {

Vector3 InSensorAxes(const Frame& frame, const Vector3& velocity_world_mps) {
  return frame.world_from_sensor.linear().transpose() * velocity_world_mps;
}

}  // namespace

bool KnowsMotion(const RecordedFrame& recorded) {
  return recorded.axes == PointAxes::kSensorAtFiring && recorded.has_pose &&
         recorded.Has("time_ns") && recorded.frame.duration_ns > 0;
}

RecordedMotion::RecordedMotion(const RecordedFrame& recorded, Compensation wanted)
    : recorded_(recorded),
      is_sensor_undone_(wanted != Compensation::kNone && KnowsMotion(recorded)),
      are_objects_undone_(wanted == Compensation::kAll && KnowsMotion(recorded) &&
                          recorded.Has("instance")),
      motion_(recorded.frame) {
  if (!are_objects_undone_) return;
  for (const RecordedObject& object : recorded.objects) {
    if (object.velocity_world_mps.isZero()) continue;
    velocities_mps_[object.instance] = InSensorAxes(recorded.frame, object.velocity_world_mps);
  }
}

Eigen::Vector3f RecordedMotion::PointOf(std::size_t slot) const {
  const Frame& frame = recorded_.frame;
  Eigen::Vector3f measured_m(frame.x[slot], frame.y[slot], frame.z[slot]);
  if (!is_sensor_undone_) return measured_m;
  const std::uint32_t time_ns = frame.time_ns[slot];
  Vector3 point_m = motion_.AtStamp(measured_m.cast<double>(), time_ns);
  // Mirror images have the instance of what they mirror, but are elsewhere.
  const bool is_clutter = recorded_.Has("outcome") && frame.outcome[slot] == Outcome::kClutter;
  if (velocities_mps_.empty() || is_clutter) return point_m.cast<float>();
  const auto moving = velocities_mps_.find(frame.instance[slot]);
  if (moving != velocities_mps_.end()) point_m -= SecondsFromNs(time_ns) * moving->second;
  return point_m.cast<float>();
}

Transform RecordedMotion::BoxOf(const RecordedObject& object) const {
  if (are_objects_undone_ || !object.points_time_ns) return object.sensor_from_box;
  const std::uint32_t time_ns = *object.points_time_ns;
  Transform box = object.sensor_from_box;
  box.translation() +=
      SecondsFromNs(time_ns) * InSensorAxes(recorded_.frame, object.velocity_world_mps);
  const bool is_as_measured =
      !is_sensor_undone_ && recorded_.axes == PointAxes::kSensorAtFiring && recorded_.has_pose;
  return is_as_measured ? AtFiring(box, time_ns) : box;
}

Transform RecordedMotion::AtFiring(const Transform& stamp_from_box, std::uint32_t time_ns) const {
  const Vector3 center_m = motion_.AtFiring(stamp_from_box.translation(), time_ns);
  Transform box = Transform::Identity();
  box.translation() = center_m;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Vector3 tip_m = stamp_from_box.translation() + stamp_from_box.linear().col(axis);
    box.linear().col(axis) = motion_.AtFiring(tip_m, time_ns) - center_m;
  }
  return box;
}

}  // namespace railcast
