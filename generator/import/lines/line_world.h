#pragma once

#include <string>
#include <vector>

#include "generator/import/lines/imported_line.h"
#include "generator/import/lines/line_stretches.h"
#include "generator/import/lines/track_lines.h"
#include "generator/import/map/rail_map.h"
#include "generator/import/network/track_network.h"
#include "railcast/structures.h"

namespace railcast {

/// Something on the map that a world cannot have as it is.
struct LeftOut {
  std::string what;
  double s_m{};
  std::string reason;
};

/// A track of a world and where it comes from.
struct WorldTrack {
  TrackDraft draft;
  std::vector<LineStretch> ways;  ///< Of the map, from point to point; they may reach farther.
};

/// What a world has besides its alignment.
struct LineWorld {
  std::vector<WorldTrack> tracks;  ///< The first is "main".
  std::vector<StructureSpec> structures;
  std::vector<LeftOut> left_out;
};

/// Begins a world with the track of its line. AddSideTracks and AddStructures add the rest.
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
