#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "railcast/transform.h"

namespace railcast {

/// The poses of a sensor, one for each frame of a recording.
struct PoseFile {
  std::vector<Transform> world_from_sensor;
  std::vector<std::int64_t> stamps_ns{};  ///< Of the frames; empty if the file does not say them.
};

/// Reads the upper three rows of a pose's matrix, 12 numbers, as KITTI writes it.
/// @param place For messages: "poses.txt:3".
/// @throws InputError "poses.txt:3: must be the 12 numbers of a pose".
[[nodiscard]] Transform ReadKittiPose(const std::string& line, const std::string& place);

/// Reads a file of poses:
/// - `.csv`: railcast's poses.csv, "stamp_ns,x,y,z,qx,qy,qz,qw";
/// - `.json`: OpenLABEL 1.0, where the `transforms` of each frame's `frame_properties` and the
///   `coordinate_systems` lead from the sensor's coordinate system to that of the world, and where
///   `timestamp` is in seconds;
/// - else lines of KITTI's: the 12 numbers of the upper three rows of a matrix.
/// @param sensor Name of the sensor's coordinate system in OpenLABEL.
/// @throws InputError "FILE:3: rule" or "FILE: pointer: rule" if it is none of these.
[[nodiscard]] PoseFile ReadPoseFile(const std::filesystem::path& file, const std::string& sensor);

}  // namespace railcast
