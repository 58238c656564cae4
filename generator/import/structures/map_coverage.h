#pragma once

#include <string>
#include <vector>

#include "generator/import/lines/imported_line.h"
#include "generator/import/map/rail_map.h"
#include "generator/import/network/line_world.h"
#include "generator/import/network/side_tracks.h"

namespace railcast {

/// How much of something the map has, and how much of that a world has.
struct Covered {
  double on_map{};
  double made{};
};

/// What the map has on a line and on the tracks beside it, made or not. Kilometres are those of
/// tracks: a tunnel with two tracks counts twice.
struct MapCoverage {
  Covered tunnels_km;
  Covered bridges_km;
  Covered second_tracks_km;  ///< Running tracks beside the line's own.
  Covered other_tracks_km;   ///< Sidings, yards, crossovers and spurs.
  Covered switches;          ///< Their number.
};

/// Measures a world against its map, metre by metre. A track is made where one of the world is
/// within 2 m of it, and its tunnel where that track is in one.
[[nodiscard]] MapCoverage CoverageOf(const RailMap& map,
                                     const LineWorld& world,
                                     const SideTrackQuality& beside);

/// A row for each thing of each line.
[[nodiscard]] std::string CoverageCsv(const std::vector<ImportedLine>& lines,
                                      const std::vector<MapCoverage>& coverages);
/// The same as a table to be read, one row for each line.
[[nodiscard]] std::string CoverageTable(const std::vector<ImportedLine>& lines,
                                        const std::vector<MapCoverage>& coverages);

/// How many switches of the map are no turnouts, by their reasons, a line each; empty if all are.
[[nodiscard]] std::string SwitchReasonsText(const std::vector<LineWorld>& worlds);
/// How much of the worlds' tracks was moved away from others; empty if nothing was.
[[nodiscard]] std::string MovedText(const std::vector<LineWorld>& worlds);

}  // namespace railcast
