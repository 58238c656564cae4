#pragma once

#include <set>
#include <string>

#include "core/rail/world/world_check.h"

namespace railcast {

/// Checks the tracks, places and vehicles of trains and of the sensor's own train. Faults are lines
/// like `/world/trains/0/vehicles/3/type: must be a vehicle that runs on rails (got "box")`.
void CheckTrains(const WorldSpec& world,
                 const VehicleSpec& vehicle,
                 const LineOfTracks& line,
                 WorldFaults& faults);

/// Checks that the vehicles of trains have names of their own.
/// @param names Those of everything else; receives the vehicles'.
void CheckNamesOfTrains(const WorldSpec& world, std::set<std::string>& names, WorldFaults& faults);

}  // namespace railcast
