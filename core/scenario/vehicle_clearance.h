#pragma once

#include <cstdint>

#include "railcast/lidar.h"
#include "railcast/scenario.h"
#include "railcast/scene.h"

namespace railcast {

/// Checks that the sensor's own vehicle is not inside an object at the stamp of any frame, unless
/// the scenario allows it (`vehicle.may_overlap`). Touching is allowed. A vehicle without ego boxes
/// is nowhere inside.
/// @throws InputError with a line for each object, about the first such frame:
///   "file: /vehicle: must not be inside an object unless may_overlap is true
///   (got 0.11 m inside "wagon" at frame 54 (5.4 s))".
/// @param world The world of the scenario.
void CheckVehicleIsClear(const ScenarioSpec& scenario,
                         const World& world,
                         const ScanPattern& pattern,
                         std::uint32_t first_frame,
                         std::uint32_t last_frame);

}  // namespace railcast
