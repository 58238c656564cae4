#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "railcast/transform.h"

namespace railcast {

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

}  // namespace railcast
