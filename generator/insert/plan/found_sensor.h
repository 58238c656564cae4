#pragma once

#include <string>
#include <vector>

#include "railcast/io/recording.h"
#include "railcast/scenario.h"

namespace railcast {

/// Gives a plan without a sensor the one that made the recording: of a sequence that of its
/// scenario, of a capture railcast's own preset, or what an Ouster sensor's metadata say.
/// @param remarks Receives which one it is.
/// @throws InputError "plan.json: /lidar: rule (got value)" if the recording does not say it.
void UseSensorOf(const RecordingInfo& info, ScenarioSpec& plan, std::vector<std::string>& remarks);

}  // namespace railcast
