#include "core/simulate/output_axes.h"

namespace railcast {

OutputAxes::OutputAxes(const OutputSpec& spec,
                       const Transform& vehicle_from_sensor,
                       const Transform& window_from_world)
    : is_left_handed_(spec.handedness == "left"),
      vehicle_from_sensor_(vehicle_from_sensor),
      world_from_window_(window_from_world.inverse()) {
  if (spec.frame == "vehicle") target_ = Target::kVehicle;
  if (spec.frame == "world") target_ = Target::kWorld;
}

void OutputAxes::Apply(const FramePoses& poses,
                       const std::uint32_t* time_ns,
                       DetectTile& detect) const {
  if (target_ == Target::kSensor && !is_left_handed_) return;
  for (std::size_t i = 0; i < detect.num_rays; ++i) {
    Vector3 point(static_cast<double>(detect.x[i]), static_cast<double>(detect.y[i]),
                  static_cast<double>(detect.z[i]));
    if (target_ == Target::kVehicle) point = vehicle_from_sensor_ * point;
    if (target_ == Target::kWorld) {
      PoseF change{};
      const PoseF pose = poses.At(time_ns[i], change);
      Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>> rotation(pose.r);
      Eigen::Map<const Eigen::Vector3f> translation(pose.t);
      point = world_from_window_ *
              (rotation.cast<double>() * point + translation.cast<double>()).eval();
    }
    detect.x[i] = static_cast<float>(point.x());
    detect.y[i] = static_cast<float>(is_left_handed_ ? -point.y() : point.y());
    detect.z[i] = static_cast<float>(point.z());
  }
}

}  // namespace railcast
