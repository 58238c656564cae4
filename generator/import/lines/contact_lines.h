#pragma once

#include "generator/import/lines/track_lines.h"
#include "generator/import/map/rail_map.h"

namespace railcast {

/// Gives every track without a tag `electrified` what is usual for its kind (`railway`): trams have
/// a contact line; other kinds have one if the tag is on at least half of their length on this map,
/// and at least half of that has one. Such tracks get the tag `import:usual`, too.
/// @pre The map is projected.
void FillElectrified(RailMap& map);

/// Whether most of a line has a contact line, as far as the map says; if it says nothing, whether
/// most of it was given one by FillElectrified.
[[nodiscard]] bool HasContactLine(const RailMap& map, const TrackLine& track);

}  // namespace railcast
