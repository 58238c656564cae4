#pragma once

#include <string>
#include <vector>

#include "core/scenario/json_text.h"
#include "generator/import/lines/imported_line.h"
#include "generator/import/lines/line_stretches.h"
#include "generator/import/lines/track_lines.h"
#include "generator/import/map/rail_map.h"
#include "generator/import/network/track_network.h"
#include "generator/import/network/track_runs.h"
#include "railcast/rail_world.h"
#include "railcast/structures.h"

namespace railcast {

/// Something on the map that a world cannot have as it is.
struct LeftOut {
  std::string what;
  double begin_s_m{};
  double end_s_m{};  ///< The same for what stands at one place.
  std::string reason;
};

/// A track of a world and where it comes from.
struct WorldTrack {
  TrackDraft draft;
  std::vector<LineStretch> ways;  ///< Of the map, from point to point; they may reach farther.
};

/// A stretch of a track that was moved away from others, to which the map has it too near.
struct MovedTrack {
  std::string name;
  double begin_s_m{};
  double end_s_m{};
  double most_m{};  ///< By which it was moved.
};

/// What a world has besides its alignment.
struct LineWorld {
  std::vector<WorldTrack> tracks;  ///< The first is "main".
  std::vector<StructureSpec> structures;
  /// The tracks of the map beside the line, made or not, and where they were moved to.
  std::vector<TrackRun> runs;
  std::vector<MovedTrack> moved;
  std::vector<LeftOut> left_out;
};

/// Begins a world with the track of its line. AddSideTracks and AddStructures add the rest.
[[nodiscard]] LineWorld MakeLineWorld(const RailMap& map,
                                      const TrackLine& track,
                                      const ImportedLine& line);

/// A track and a structure as scenario files have them, without keys that have their defaults.
[[nodiscard]] Json JsonOf(TrackSpec track);
[[nodiscard]] Json JsonOf(StructureSpec structure);

/// The world as a file that a scenario may name, with one item to a line of text.
/// @param has_elevation Whether NAME.elevation.asc stands beside it.
[[nodiscard]] std::string WorldFileText(const ImportedLine& line,
                                        const LineWorld& world,
                                        bool has_elevation);

/// A line that cannot stand.
struct LeftOutLine {
  std::string name;
  double length_m{};
  std::string reason;
};

/// What was left out as CSV: whole lines first, then what worlds lack.
[[nodiscard]] std::string LeftOutCsv(const std::vector<LeftOutLine>& left_out,
                                     const std::vector<ImportedLine>& lines,
                                     const std::vector<LineWorld>& worlds);

/// The stretches of tracks that were moved away from others, as CSV.
[[nodiscard]] std::string MovedCsv(const std::vector<ImportedLine>& lines,
                                   const std::vector<LineWorld>& worlds);

}  // namespace railcast
