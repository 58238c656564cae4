#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/rail/line/track_course.h"
#include "generator/extras/import/heights/elevation_map.h"
#include "generator/extras/import/lines/imported_line.h"
#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/map/map_projection.h"
#include "generator/extras/import/map/rail_map.h"

namespace railcast {

/// Gives a line the surveyed cants of the map's points (MapNode::cant_mm), linear between them. The
/// outer rail of the fitted line is the higher one. Points without one have none, but if no point
/// of the line has any, it is left to the rule except for some stretches (LevelCant).
void SetCants(const RailMap& map,
              const TrackLine& track,
              std::span<const ChainageRange> level,
              ImportedLine& line);

/// Whether any point of a line has a surveyed cant.
[[nodiscard]] bool HasSurveyedCant(const RailMap& map, const TrackLine& track);

/// Takes the cant by the rule from those of some stretches of a line that it gives any, with ramps
/// to either side. If it gives none to any of them, the line stays as it is.
/// @pre The line has no surveyed cant.
void LevelCant(std::span<const ChainageRange> level, AlignmentSpec& line);

/// What of an elevation model is kept for a line: that within 500 m of it, since so far sensors
/// see.
[[nodiscard]] Eigen::AlignedBox2d ElevationBounds(const RailMap& map, const TrackLine& track);

/// Reads an elevation model about some lines.
/// @throws InputError as ElevationMap does, and if the model ends before one of the lines does.
[[nodiscard]] std::unique_ptr<const ElevationMap> ReadElevation(
    const std::filesystem::path& file,
    const std::string& crs,
    const MapProjection& projection,
    const RailMap& map,
    const std::vector<TrackLine>& tracks);

/// Gives a line its heights.
///
/// Those of an elevation model are taken at least every 20 m, or every cell, but not on bridges and
/// in tunnels and within a cell of these, where the model's ground is not the line's.
/// @param elevation Null: the heights of the map's points count, and the line is left level if
///   fewer than two have any.
/// @returns Why they cannot be its own: one in a hundred is farther than kFarthestHeight_m from
///   gradients that a railway can have. Absent if they can.
/// @throws InputError if the model has no height along the line.
[[nodiscard]] std::optional<std::string> SetHeights(const RailMap& map,
                                                    const TrackLine& track,
                                                    const ElevationMap* elevation,
                                                    ImportedLine& line);

}  // namespace railcast
