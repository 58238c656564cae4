#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "railcast/transform.h"

namespace railcast {

/// Poses that were estimated from clouds alone.
struct RegisteredPoses {
  std::vector<Transform> world_from_sensor;  ///< For each frame.
  double median_residual_m{};                ///< Root mean square of a frame's distances.
  double worst_residual_m{};
  std::size_t worst_frame{};
};

/// Lays each cloud of a recording on the one before it: iterative closest points, from points to
/// planes (Chen and Medioni, 1992), with PCL. The motion within a scan is left out. The vehicle
/// begins at the world's origin.
/// @throws InputError "frame: rule (got value)" if a cloud cannot be laid on the one before it.
[[nodiscard]] RegisteredPoses RegisterClouds(const std::filesystem::path& recording,
                                             const Transform& vehicle_from_sensor);

}  // namespace railcast
