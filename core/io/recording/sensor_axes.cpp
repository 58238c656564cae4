#include "core/io/recording/sensor_axes.h"

#include <cmath>
#include <vector>

#include "core/base/error.h"
#include "core/io/cloud/scan_motion.h"

namespace railcast {
namespace {

// Calls `move` for every point and stores the result in place.
template <typename Move>
void MovePoints(Frame& frame, Move&& move) {
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    if (std::isnan(frame.x[i])) continue;
    const Vector3 point_m(static_cast<double>(frame.x[i]), static_cast<double>(frame.y[i]),
                          static_cast<double>(frame.z[i]));
    const Eigen::Vector3f moved_m = move(point_m, i).template cast<float>();
    frame.x[i] = moved_m.x();
    frame.y[i] = moved_m.y();
    frame.z[i] = moved_m.z();
  }
}

std::vector<std::uint32_t> TimesOf(const RecordedFrame& recorded, const ScanPattern& pattern) {
  const Frame& frame = recorded.frame;
  if (recorded.Has("time_ns")) return frame.time_ns;
  if (!recorded.is_grid) {
    throw InputError(recorded.name +
                     ": time_ns, or ring and column: must be there to take world coordinates back "
                     "into the sensor's axes");
  }
  std::vector<std::uint32_t> times_ns(frame.num_slots());
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const std::size_t first = (std::size_t{pattern.row[i]} * frame.columns + pattern.column[i]) *
                              std::size_t{frame.returns};
    for (std::size_t r = 0; r < frame.returns; ++r) times_ns[first + r] = pattern.time_ns[i];
  }
  return times_ns;
}

}  // namespace

void UndoOutputAxes(const OutputSpec& output,
                    const Transform& vehicle_from_sensor,
                    const ScanPattern& pattern,
                    RecordedFrame& recorded) {
  Frame& frame = recorded.frame;
  if (output.handedness == Handedness::kLeft) {
    for (float& y : frame.y) y = -y;
  }
  if (output.frame == OutputFrame::kVehicle) {
    const Transform sensor_from_vehicle = vehicle_from_sensor.inverse();
    MovePoints(frame, [&](const Vector3& point_m, std::size_t) -> Vector3 {
      return sensor_from_vehicle * point_m;
    });
  }
  if (output.frame != OutputFrame::kWorld) return;
  const std::vector<std::uint32_t> times_ns = TimesOf(recorded, pattern);
  const ScanMotion motion(frame);
  const Vector3 origin_m(output.origin_m[0], output.origin_m[1], output.origin_m[2]);
  const Transform sensor_from_world = frame.world_from_sensor.inverse();
  MovePoints(frame, [&](const Vector3& point_m, std::size_t i) -> Vector3 {
    return motion.AtFiring(sensor_from_world * (point_m + origin_m), times_ns[i]);
  });
}

void TurnToSpinAxes(Frame& frame) {
  if (!frame.sensor_from_spin) return;
  const Transform sensor_from_spin = MakeTransform(*frame.sensor_from_spin, Vector3::Zero());
  const Transform spin_from_sensor = sensor_from_spin.inverse();
  MovePoints(frame, [&](const Vector3& point_m, std::size_t) -> Vector3 {
    return spin_from_sensor * point_m;
  });
  frame.world_from_sensor = frame.world_from_sensor * sensor_from_spin;
  frame.world_from_sensor_end = frame.world_from_sensor_end * sensor_from_spin;
  for (ScanPose& pose : frame.poses_between) {
    pose.world_from_sensor = pose.world_from_sensor * sensor_from_spin;
  }
  frame.sensor_from_spin.reset();
}

}  // namespace railcast
