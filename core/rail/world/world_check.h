#pragma once

#include <string>

#include "core/rail/base/world_faults.h"
#include "core/rail/network/world_tracks.h"
#include "railcast/world_spec.h"

namespace railcast {

/// Checks a world and its vehicle for consistency with each other and with the line. Faults are
/// lines like `/world/objects/3/track: must be one of "main", "siding" (got "sidng")`. Speed
/// profiles are checked separately (SpeedProfile), and so is the network (DraftNetwork,
/// CheckNetwork).
/// @param line Infinite measures if the line is unknown.
void CheckWorld(const WorldSpec& world,
                const VehicleSpec& vehicle,
                const LineOfTracks& line,
                WorldFaults& faults);

/// Checks the place of one object. Faults are lines that begin with `pointer`.
void CheckObject(const WorldSpec& world,
                 const ObjectSpec& object,
                 const std::string& pointer,
                 const LineOfTracks& line,
                 WorldFaults& faults);

}  // namespace railcast
