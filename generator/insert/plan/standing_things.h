#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "generator/insert/insert_plan.h"
#include "generator/insert/plan/recorded_way.h"
#include "generator/insert/plan/recorded_world.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"

namespace railcast {

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
