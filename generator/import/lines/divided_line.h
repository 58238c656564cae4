#pragma once

#include <vector>

#include "generator/import/lines/track_lines.h"
#include "generator/import/map/rail_map.h"

namespace railcast {

/// The parts of a line that keep clear of themselves, in their order: a world's ground has no room
/// between two parts of its line that run beside or across each other (StripWidth), as before and
/// behind the loop at the end of a tramway. Of the loop between two such places, half goes to
/// either part.
[[nodiscard]] std::vector<TrackLine> DividedWhereItMeetsItself(const RailMap& map,
                                                               const TrackLine& line);

}  // namespace railcast
