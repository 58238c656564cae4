#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "generator/insert/plan/recorded_way.h"
#include "railcast/transform.h"

namespace railcast {

/// The ground at a place, as the recording has it.
struct RecordedGround {
  double height_m{};         ///< Of the world, at the place.
  Vector3 up{0, 0, 1};       ///< Unit normal in the world.
  double residual_m{};       ///< Root mean square distance of its points.
  std::size_t num_points{};  ///< In the plane; 0 = no ground was found.
  double radius_m{};         ///< Of the circle in plan that they are in.
  [[nodiscard]] bool is_found() const { return num_points > 0; }
};

/// Finds the ground at places of the world: the plane near the horizontal that most points in a
/// small circle about the place are in (PCL's MLESAC, refined by least squares), of up to eight
/// frames whose sensor is 3 to 60 m away.
/// @param places_m Where to look; the height is about that of the ground.
/// @return One for each place.
[[nodiscard]] std::vector<RecordedGround> FindGround(const std::filesystem::path& recording,
                                                     const RecordedWay& way,
                                                     const Transform& vehicle_from_sensor,
                                                     const std::vector<Vector3>& places_m);

}  // namespace railcast
