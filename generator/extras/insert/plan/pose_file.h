#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "railcast/transform.h"

namespace railcast {

inline constexpr double kMostSpeed_mps = 150.0;  ///< The fastest train reached 168, on rails.
inline constexpr double kMostFrameStep_s = 10.0;

/// Checks the speed over a whole way.
/// @throws InputError "place: poses: rule (got value)" if it is more than kMostSpeed_mps.
void CheckSpeed(double length_m, double time_s, const std::string& place);

/// What stands beside the clouds of a sequence of KITTI's odometry benchmark.
struct KittiPoses {
  std::vector<Transform> world_from_sensor;  ///< The world is the first sensor frame. Or empty.
  std::vector<std::int64_t> times_ns;        ///< Or empty.
};

/// Reads poses.txt, with Tr of calib.txt, and times.txt beside the folder `velodyne`. What is not
/// there is left empty.
/// @param source The sequence's folder, or the data set's if it holds one sequence.
/// @throws InputError "poses.txt:3: rule" if a line is not KITTI's, or if there is not one for
///   each frame.
[[nodiscard]] KittiPoses ReadKittiPoses(const std::filesystem::path& source,
                                        std::size_t num_frames);

/// The poses of a sensor, one for each frame of a recording.
struct PoseFile {
  std::vector<Transform> world_from_sensor;
  std::vector<std::int64_t> stamps_ns{};  ///< Empty if the file does not say them.
  std::int64_t step_ns{};                 ///< Median of the differences of stamps.
};

/// Reads a file of poses:
/// - `.csv`: railcast's poses.csv, "stamp_ns,x,y,z,qx,qy,qz,qw";
/// - `.json`: OpenLABEL 1.0, where the `transforms` of each frame's `frame_properties` and the
///   `coordinate_systems` lead from the sensor's coordinate system to that of the world, and where
///   `timestamp` is in seconds;
/// - else lines of KITTI's, the 12 numbers of the upper three rows of a matrix, or of TUM's: time
/// in
///   seconds, x, y, z, qx, qy, qz, qw.
/// Text may have a byte order mark or be UTF-16.
/// @param sensor Name of the sensor's coordinate system in OpenLABEL.
/// @param most_step_s Of frames. Stations of a survey may be any time apart.
/// @throws InputError "FILE:3: rule" or "FILE: pointer: rule" if it is none of these, if its times
///   are not 0.01 s to most_step_s apart in the median, if z does not point up, or as CheckSpeed().
/// Poses that turn the sensor upside down are told as a remark.
[[nodiscard]] PoseFile ReadPoseFile(const std::filesystem::path& file,
                                    const std::string& sensor,
                                    double most_step_s = kMostFrameStep_s);

struct FrameStamp {
  std::size_t frame{};  ///< Index of its pose.
  std::int64_t stamp_ns{};
};

/// Holds the times of poses against those of frames, if both have some: the differences must agree;
/// a remark says if the times themselves do not.
/// @throws InputError "place: times: rule (got value)" if one since the first differs by more than
///   half a step.
void CheckFrameStamps(const PoseFile& poses,
                      const std::vector<FrameStamp>& frames,
                      const std::string& place);

}  // namespace railcast
