#include "core/simulate/output_axes.h"

#include <iomanip>
#include <sstream>

#include "core/base/error.h"

namespace railcast {

namespace {

// float32 resolves 0.5 mm below this value, but only 1 mm or less above.
constexpr double kMillimetreReach_m = 8192.0;

void CheckReach(const std::string& place, const Vector3& origin_m, const Vector3& sensor_m) {
  if ((sensor_m - origin_m).cwiseAbs().maxCoeff() <= kMillimetreReach_m) return;
  std::ostringstream value;
  value << "[" << origin_m.x() << ", " << origin_m.y() << ", " << origin_m.z() << "], sensor at ["
        << std::fixed << std::setprecision(0) << sensor_m.x() << ", " << sensor_m.y() << ", "
        << sensor_m.z() << "]";
  throw InputError(
      {{place, "must lie within 8192 m of the sensor, since float32 loses millimetres beyond",
        value.str()}});
}

}  // namespace

OutputAxes::OutputAxes(const OutputSpec& spec,
                       const std::string& origin_place,
                       const ReportedMount& mount,
                       const Transform& window_from_world,
                       const Transform& world_from_sensor)
    : is_left_handed_(spec.handedness == Handedness::kLeft),
      mount_(mount),
      output_from_window_(window_from_world.inverse()) {
  if (spec.frame == OutputFrame::kVehicle) target_ = Target::kVehicle;
  if (spec.frame != OutputFrame::kWorld) return;
  target_ = Target::kWorld;
  const Vector3 origin_m(spec.origin_m[0], spec.origin_m[1], spec.origin_m[2]);
  CheckReach(origin_place, origin_m, world_from_sensor.translation());
  output_from_window_.pretranslate(-origin_m);
}

void OutputAxes::Apply(const FramePoses& poses,
                       const std::uint32_t* time_ns,
                       EchoTiles& echoes) const {
  if (target_ == Target::kSensor && !is_left_handed_) return;
  for (std::size_t i = 0; i < echoes.first.num_rays; ++i) {
    Apply(poses, time_ns[i], {echoes.first, i});
  }
  for (std::size_t i = 0; i < echoes.num_more(); ++i) {
    Apply(poses, time_ns[echoes.beam_of(i)], echoes.more(i));
  }
}

void OutputAxes::Apply(const FramePoses& poses,
                       std::uint32_t time_ns,
                       const EchoTiles::Place& echo) const {
  const auto& [tile, lane] = echo;
  Vector3 point(static_cast<double>(tile.x[lane]), static_cast<double>(tile.y[lane]),
                static_cast<double>(tile.z[lane]));
  if (target_ == Target::kVehicle) point = mount_.vehicle_from_sensor * point;
  if (target_ == Target::kWorld) {
    point = mount_.true_from_reported * point;
    PoseF change{};
    const PoseF pose = poses.At(time_ns, change);
    Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>> rotation(pose.r);
    Eigen::Map<const Eigen::Vector3f> translation(pose.t);
    point =
        output_from_window_ * (rotation.cast<double>() * point + translation.cast<double>()).eval();
  }
  tile.x[lane] = static_cast<float>(point.x());
  tile.y[lane] = static_cast<float>(is_left_handed_ ? -point.y() : point.y());
  tile.z[lane] = static_cast<float>(point.z());
}

}  // namespace railcast
