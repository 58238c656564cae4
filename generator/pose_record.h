#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/transform.h"

namespace railcast {

/// The rotation as a quaternion with w >= 0: of the two that mean the same, always one.
[[nodiscard]] Eigen::Quaterniond CanonicalRotation(const Transform& transform);

/// When and where the sensor was at a frame's stamp.
struct PoseRecord {
  std::int64_t stamp_ns{};
  Vector3 position_m = Vector3::Zero();  ///< World.
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();

  PoseRecord() = default;
  PoseRecord(std::int64_t stamp, const Transform& world_from_sensor);

  [[nodiscard]] Transform WorldFromSensor() const;
};

/// The first line of poses.csv.
inline constexpr std::string_view kPosesHeader = "stamp_ns,x,y,z,qx,qy,qz,qw\n";

/// A line of poses.csv, in digits that give the same doubles back.
[[nodiscard]] std::string PoseLine(const PoseRecord& pose);

/// Reads one back. @pre PoseLine wrote it.
[[nodiscard]] PoseRecord ParsePoseLine(std::string_view line);

}  // namespace railcast
