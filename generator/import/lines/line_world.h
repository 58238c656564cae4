#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "generator/import/lines/imported_line.h"
#include "generator/import/lines/track_lines.h"
#include "generator/import/map/rail_map.h"

namespace railcast {

using WorldJson = nlohmann::ordered_json;

/// Something on the map that a world cannot have as it is.
struct LeftOut {
  std::string what;
  double s_m{};
  std::string reason;
};

/// What a world has besides its alignment, as in scenario files.
struct LineWorld {
  std::vector<WorldJson> tracks;      ///< The first is "main".
  std::vector<WorldJson> structures;  ///< Bridges and tunnels first.
  std::vector<LeftOut> left_out;
};

/// Makes a world of what the map says about a line.
///
/// Bridges, tunnels, slab track and conductor rails come from the tags of its ways. Things that
/// stand on the line, within 2 m of its axis, become level crossings, signals, kilometre boards,
/// derailers and, at its ends, buffer stops. Platforms whose nearest point is between 1 and 4.5 m
/// from the axis get an edge there.
[[nodiscard]] LineWorld MakeLineWorld(const RailMap& map,
                                      const TrackLine& track,
                                      const ImportedLine& line);

/// The world as a file that a scenario may name, with one item to a line of text.
/// @param has_elevation Whether NAME.elevation.asc stands beside it.
[[nodiscard]] std::string WorldFileText(const ImportedLine& line,
                                        const LineWorld& world,
                                        bool has_elevation);

/// What was left out of all worlds as CSV.
[[nodiscard]] std::string LeftOutCsv(const std::vector<ImportedLine>& lines,
                                     const std::vector<LineWorld>& worlds);

}  // namespace railcast
