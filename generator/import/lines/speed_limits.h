#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "generator/import/lines/track_lines.h"
#include "generator/import/map/rail_map.h"
#include "railcast/alignment.h"

namespace railcast {

/// The value of OpenStreetMap's key `maxspeed` in km/h: "120", "50 mph". Absent for anything else
/// ("none", "signals", "80;100") and for what is not above 0 and at most 1000 km/h.
[[nodiscard]] std::optional<double> SpeedOf_kmph(std::string_view maxspeed);

/// The speed of each of a line's ways, in their order. Where a way has none, that of the nearest
/// one that has counts; `otherwise_kmph` if none has.
[[nodiscard]] std::vector<double> SpeedsAlong_kmph(const RailMap& map,
                                                   const TrackLine& line,
                                                   double otherwise_kmph);

}  // namespace railcast
