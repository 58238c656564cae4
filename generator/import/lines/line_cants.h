#pragma once

#include "generator/import/lines/imported_line.h"
#include "generator/import/lines/track_lines.h"
#include "generator/import/map/rail_map.h"

namespace railcast {

/// Gives a line the surveyed cants of the map's points (MapNode::cant_mm), linear between them. The
/// outer rail of the fitted line is the higher one. Points without one have none, but if no point
/// of the line has any, it is left to the rule.
void SetCants(const RailMap& map, const TrackLine& track, ImportedLine& line);

}  // namespace railcast
