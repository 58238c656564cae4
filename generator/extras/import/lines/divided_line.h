#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/extras/import/lines/imported_line.h"
#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/map/rail_map.h"

namespace railcast {

/// What is left of a line without its arcs that are too sharp for any vehicle.
struct LineBesideArcs {
  std::vector<TrackLine> parts;  ///< In order, named NAME-part-1 and so on.
  std::string reason;            ///< Names the arcs with their radii.
  double cut_m{};                ///< How much of the line is between the parts.
};

/// Cuts a line at the arcs whose radius is less than the distance of a vehicle's pivots, for which
/// check refuses its world; absent if it has none. Parts are shorter than the line, so that cutting
/// comes to an end.
[[nodiscard]] std::optional<LineBesideArcs> CutAtSharpArcs(const RailMap& map,
                                                           const TrackLine& track,
                                                           const ImportedLine& line);

/// The parts of a line that keep clear of themselves, in their order: a world's ground has no room
/// between two parts of its line that run beside or across each other (StripWidth), as before and
/// behind the loop at the end of a tramway. Of the loop between two such places, half goes to
/// either part.
[[nodiscard]] std::vector<TrackLine> DividedWhereItMeetsItself(const RailMap& map,
                                                               const TrackLine& line);

}  // namespace railcast
