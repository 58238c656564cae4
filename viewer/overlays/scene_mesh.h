#pragma once

#include <vector>

#include "core/base/transform.h"
#include "core/io/recording/recording.h"
#include "core/scene/mesh.h"
#include "viewer/overlays/surroundings.h"

namespace railcast {

/// How far from the sensor the scene's surfaces are shown ...
inline constexpr double kSceneRange_m = 150.0;
/// ... and those of sleepers and ballast, which are many: 150 m of them are half a million
/// triangles.
inline constexpr double kTrackBedRange_m = 50.0;

/// What never moves about a vehicle that is anywhere in one chunk of the line: the ground, rails,
/// sleepers and ballast, and the contact line with its masts.
///
/// Left out: trees and grass, whose leaves are nine tenths of all triangles (8 of 9 million in
/// scenarios/st_gallen_approach.json), and the sleepers' fastenings, a quarter of a million more.
/// Triangles beyond kSceneRange_m or kTrackBedRange_m of all such vehicles are left out, too.
struct StandingScene {
  Transform world_from_home = Transform::Identity();  ///< Of that chunk.
  std::vector<Part> parts;  ///< In the chunk's frame, one for each label and material.
};

/// Depends on the chunk (RailWorld::HomeChunk()) alone: worth keeping as long as the vehicle is in
/// it.
[[nodiscard]] StandingScene GatherStandingScene(const Surroundings& surroundings, int home_chunk);

/// The scenario's objects where they are at the stamp, in the sensor's axes then, but for the
/// sensor's own vehicle and for those whose origin is beyond kSceneRange_m. One part for each label
/// and material. Empty if the frame has no pose.
[[nodiscard]] std::vector<Part> GatherSceneObjects(const Surroundings& surroundings,
                                                   const RecordedFrame& recorded);

}  // namespace railcast
