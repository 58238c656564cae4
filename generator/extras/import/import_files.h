#pragma once

#include <string>
#include <vector>

#include "core/scenario/json_text.h"
#include "generator/extras/import/lines/imported_line.h"
#include "generator/extras/import/map/map_projection.h"
#include "generator/extras/import/network/line_world.h"
#include "railcast/remark.h"
#include "railcast/structures.h"
#include "railcast/world_spec.h"

namespace railcast {

/// An alignment as a file that a scenario's world may name, with one element to a line of text.
[[nodiscard]] std::string AlignmentFileText(const ImportedLine& line,
                                            const MapProjection& projection);

/// The qualities of all lines as CSV, one row for each.
[[nodiscard]] std::string QualityCsv(const std::vector<ImportedLine>& lines);
/// The same as a table to be read.
[[nodiscard]] std::string QualityTable(const std::vector<ImportedLine>& lines);
/// The qualities of all lines' heights as CSV, one row for each that has heights.
[[nodiscard]] std::string HeightsCsv(const std::vector<ImportedLine>& lines);
/// All contradictions as CSV.
[[nodiscard]] std::string ContradictionsCsv(const std::vector<ImportedLine>& lines);

/// A track and a structure as scenario files have them, without keys that have their defaults.
[[nodiscard]] Json JsonOf(TrackSpec track);
[[nodiscard]] Json JsonOf(StructureSpec structure);

/// The world as a file that a scenario may name, with one item to a line of text.
/// @param has_elevation Whether NAME.elevation.asc stands beside it.
[[nodiscard]] std::string WorldFileText(const ImportedLine& line,
                                        const LineWorld& world,
                                        bool has_elevation);

/// What was not taken as it is.
struct LeftOutOfMap {
  std::vector<Remark> remarks;  ///< About the map and its heights.
  std::vector<LeftOutLine> lines;
};

/// What was left out as CSV: of the map, whole lines, then what worlds lack.
[[nodiscard]] std::string LeftOutCsv(const LeftOutOfMap& left_out,
                                     const std::vector<ImportedLine>& lines,
                                     const std::vector<LineWorld>& worlds);

/// The stretches of tracks that are not where the map has them (MovedTracksOf), as CSV.
[[nodiscard]] std::string MovedCsv(const std::vector<ImportedLine>& lines,
                                   const std::vector<LineWorld>& worlds);
/// How much that is, as text; empty if all is.
[[nodiscard]] std::string MovedText(const std::vector<LineWorld>& worlds);

}  // namespace railcast
