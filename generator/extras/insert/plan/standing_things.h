#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "generator/extras/insert/insert_plan.h"
#include "generator/extras/insert/plan/recorded_way.h"
#include "generator/extras/insert/plan/recorded_world.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "railcast/transform.h"

namespace railcast {

/// The ground at a place, as the recording has it.
struct RecordedGround {
  double height_m{};         ///< Height in the world, at the place.
  Vector3 up{0, 0, 1};       ///< Unit normal in the world.
  double residual_m{};       ///< Root mean square distance of its points.
  std::size_t num_points{};  ///< In the plane; 0 = no ground was found.
  double radius_m{};         ///< Radius of the circle in plan that they are in.
  [[nodiscard]] bool is_found() const { return num_points > 0; }
};

/// Finds the ground at places of the world: the plane near the horizontal that most points in a
/// small circle about the place are in (PCL's MLESAC, refined by least squares), of up to eight
/// frames whose sensor is 3 to 60 m away, or nearer where there are no such frames.
/// @param places_m Where to look; the height is about that of the ground.
/// @return One for each place.
[[nodiscard]] std::vector<RecordedGround> FindGround(const std::filesystem::path& recording,
                                                     const RecordedWay& way,
                                                     const Transform& vehicle_from_sensor,
                                                     const std::vector<Vector3>& places_m);

/// Finds out which objects of a plan stand on the ground and which of them follow its slope. The
/// plan then has them upright, so that only the recorded ground tilts them.
/// @return One for each object, without ground; see StandOnGround().
[[nodiscard]] std::vector<StandOnRecording> LetGoOfGround(ScenarioSpec& plan);

/// Finds the recorded ground below the objects that stand on it: below those that move at places
/// along their way during the recording, about 1 m apart. Where none is seen, ground is taken to be
/// as high as beside it, or else in the plane of the rails.
/// @param things The objects' own world. @param stands As LetGoOfGround() returned them.
/// @param places Of the objects; receives what was found.
/// @param remarks Receives a sentence for each object: the ground, its residual, or that there is
///   none.
void StandOnGround(const std::filesystem::path& recording,
                   const RecordedWay& way,
                   const ScenarioSpec& plan,
                   const RailWorld& things,
                   std::vector<StandOnRecording>& stands,
                   std::vector<PlacedThing>& places,
                   std::vector<std::string>& remarks);

}  // namespace railcast
