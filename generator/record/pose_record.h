#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "railcast/transform.h"

namespace railcast {

/// Returns the rotation as a quaternion with w >= 0, so that of the two for the same rotation it is
/// always the same one.
[[nodiscard]] Eigen::Quaterniond CanonicalRotation(const Transform& transform);

/// Time and pose of the sensor at a frame's stamp.
struct PoseRecord {
  std::int64_t stamp_ns{};
  Vector3 position_m = Vector3::Zero();  ///< In the world frame.
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();

  PoseRecord() = default;
  PoseRecord(std::int64_t stamp, const Transform& world_from_sensor);

  [[nodiscard]] Transform WorldFromSensor() const;
};

/// The first line of poses.csv.
inline constexpr std::string_view kPosesHeader = "stamp_ns,x,y,z,qx,qy,qz,qw\n";

/// Returns a line of poses.csv with enough digits to restore the same doubles.
[[nodiscard]] std::string PoseLine(const PoseRecord& pose);

/// Parses such a line.
/// @pre The line was written by PoseLine.
[[nodiscard]] PoseRecord ParsePoseLine(std::string_view line);

}  // namespace railcast
