#pragma once

#include <vector>

#include "railcast/io/recording.h"
#include "railcast/scene.h"
#include "railcast/transform.h"
#include "viewer/overlays/overlays.h"

namespace railcast {

/// Surfaces of the scene are shown up to this distance from the sensor.
inline constexpr double kSceneRange_m = 150.0;
/// Those of sleepers and ballast have a shorter limit, because 150 m of them are half a million
/// triangles.
inline constexpr double kTrackBedRange_m = 50.0;

/// The standing scene about a vehicle that is anywhere in one chunk of the line: the ground, rails,
/// sleepers and ballast, and the contact line with its masts.
///
/// Trees and grass are left out, because their leaves are nine tenths of all triangles (8 of 9
/// million in scenarios/st_gallen_approach.json), and so are the sleepers' fastenings, another
/// quarter of a million. Triangles beyond kSceneRange_m or kTrackBedRange_m of every such vehicle
/// are left out, too.
struct StandingScene {
  Transform world_from_home = Transform::Identity();  ///< Frame of the chunk.
  std::vector<Part> parts;  ///< In the chunk's frame, one per label and material.
};

/// The result depends only on the chunk (RailWorld::HomeChunk()), so it can be kept as long as the
/// vehicle is in it.
[[nodiscard]] StandingScene GatherStandingScene(const Surroundings& surroundings, int home_chunk);

/// Returns the scenario's objects where they are at the stamp, in the sensor's axes then, one part
/// per label and material. The sensor's own vehicle and objects whose origin is beyond
/// kSceneRange_m are left out. Empty if the frame has no pose.
[[nodiscard]] std::vector<Part> GatherSceneObjects(const Surroundings& surroundings,
                                                   const RecordedFrame& recorded);

}  // namespace railcast
