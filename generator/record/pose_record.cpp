#include "generator/record/pose_record.h"

#include <array>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/text_cursor.h"

namespace railcast {

Eigen::Quaterniond CanonicalRotation(const Transform& transform) {
  Eigen::Quaterniond rotation(transform.linear());
  if (rotation.w() < 0.0) rotation.coeffs() = -rotation.coeffs();
  return rotation;
}

PoseRecord::PoseRecord(std::int64_t stamp, const Transform& world_from_sensor)
    : stamp_ns(stamp),
      position_m(world_from_sensor.translation()),
      rotation(CanonicalRotation(world_from_sensor)) {}

Transform PoseRecord::WorldFromSensor() const {
  return MakeTransform(rotation.toRotationMatrix(), position_m);
}

std::string PoseLine(const PoseRecord& pose) {
  std::string line = NumberText(pose.stamp_ns);
  for (const double value :
       {pose.position_m.x(), pose.position_m.y(), pose.position_m.z(), pose.rotation.x(),
        pose.rotation.y(), pose.rotation.z(), pose.rotation.w()}) {
    line += ',';
    line += NumberText(value);
  }
  return line + "\n";
}

PoseRecord ParsePoseLine(std::string_view line) {
  const auto take = [&line] {
    const std::size_t end = line.find_first_of(",\n");
    Check(end != std::string_view::npos, "a line of poses.csv has eight numbers");
    const std::string_view word = line.substr(0, end);
    line.remove_prefix(end + 1);
    return word;
  };
  PoseRecord pose;
  const auto stamp = ParseNumber<std::int64_t>(take());
  Check(stamp.has_value(), "poses.csv begins with the stamp");
  pose.stamp_ns = *stamp;
  std::array<double, 7> values{};
  for (double& value : values) {
    const auto number = ParseNumber<double>(take());
    Check(number.has_value(), "poses.csv holds numbers");
    value = *number;
  }
  pose.position_m = Vector3(values[0], values[1], values[2]);
  pose.rotation = Eigen::Quaterniond(values[6], values[3], values[4], values[5]);
  return pose;
}

}  // namespace railcast
