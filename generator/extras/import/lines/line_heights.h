#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/rail/line/track_course.h"
#include "generator/extras/import/heights/elevation_map.h"
#include "generator/extras/import/lines/imported_line.h"
#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/map/rail_map.h"

namespace railcast {

/// Gives a line the surveyed cants of the map's points (MapNode::cant_mm), linear between them. The
/// outer rail of the fitted line is the higher one. Points without one have none, but if no point
/// of the line has any, it is left to the rule.
void SetCants(const RailMap& map, const TrackLine& track, ImportedLine& line);

/// Whether any point of a line has a surveyed cant.
[[nodiscard]] bool HasSurveyedCant(const RailMap& map, const TrackLine& track);

/// Takes the cant by the rule from those of some stretches of a line that it gives any, with ramps
/// to either side. If it gives none to any of them, the line stays as it is.
/// @pre The line has no surveyed cant.
void LevelCant(std::span<const ChainageRange> level, AlignmentSpec& line);

/// @throws InputError if the model ends before one of the lines does.
/// @param name Of the model, for messages.
void CheckCovers(const RailMap& map,
                 const std::vector<TrackLine>& tracks,
                 const ElevationMap& elevation,
                 const std::string& name);

/// Gives a line the heights of an elevation model: one at least every 20 m, or every cell, but none
/// on bridges and in tunnels and within a cell of these, where the model's ground is not the
/// line's.
/// @param name Of the model, for messages.
/// @throws InputError if the model has no height along the line.
void SetHeights(const RailMap& map,
                const TrackLine& track,
                const ElevationMap& elevation,
                const std::string& name,
                ImportedLine& line);

/// Gives a line the heights of the map's points; leaves it level if fewer than two have any.
void SetHeights(const RailMap& map, const TrackLine& track, ImportedLine& line);

}  // namespace railcast
