#pragma once

#include <string>

#include "generator/insert/plan/recorded_line.h"
#include "generator/insert/plan/recorded_way.h"
#include "railcast/scenario.h"

namespace railcast {

/// Says where the plan wants an object: "frame 120, s_m 60, d_m 0.4".
[[nodiscard]] std::string AskedPlace(const ObjectSpec& object);

/// Turns the places of a plan's objects and trains, which count from the first frame, from where
/// the vehicle is in a frame or from the sensor there, into those of the line's alignment.
/// @throws InputError with a line for every fault: "plan.json: /world/objects/0/frame: rule (got
///   value)".
void PlaceThings(const RecordedWay& way, const RecordedLine& line, ScenarioSpec& plan);

}  // namespace railcast
