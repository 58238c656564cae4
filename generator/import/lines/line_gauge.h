#pragma once

#include <optional>
#include <string_view>

#include "generator/import/lines/track_lines.h"
#include "generator/import/map/rail_map.h"
#include "railcast/alignment.h"

namespace railcast {

/// The gauge that a value of OpenStreetMap's key `gauge` gives, such as "760" or "1435;1000": of
/// several, 1435 mm or else the first one. Absent if it is none that a world can have.
[[nodiscard]] std::optional<double> GaugeOf_mm(std::string_view gauge);

/// The gauge of the greatest part of a line; 1435 mm where the map has none.
[[nodiscard]] double GaugeAlong_mm(const RailMap& map, const TrackLine& line);

}  // namespace railcast
