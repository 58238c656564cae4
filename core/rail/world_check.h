#pragma once

#include <string>

#include "core/base/error.h"
#include "core/rail/world_spec.h"

namespace railcast {

/// What the rules below need to know of the line.
struct LineMeasures {
  double length_m{};
  double tightest_radius_m{};
};

/// Faults of a world and its vehicle against each other and the line, as lines like
/// `/world/objects/3/track: must be one of "main", "siding" (got "sidng")`. Speed profiles have
/// rules of their own (SpeedProfile).
void CheckWorld(const WorldSpec& world,
                const VehicleSpec& vehicle,
                const LineMeasures& line,
                ErrorList& errors);

/// Every line of `error` with `place` put before it.
void AddBelow(const std::string& place, const InputError& error, ErrorList& errors);

/// The track of that name, or null.
[[nodiscard]] const TrackSpec* FindTrack(const WorldSpec& world, const std::string& name);

}  // namespace railcast
