#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/scenario/json_text.h"
#include "generator/extras/import/lines/imported_line.h"
#include "generator/extras/import/map/map_projection.h"
#include "generator/extras/import/network/line_world.h"
#include "generator/extras/import/structures/map_account.h"
#include "railcast/remark.h"
#include "railcast/structures.h"
#include "railcast/world_spec.h"

namespace railcast {

/// An alignment as a file that a scenario's world may name, with one element to a line of text.
[[nodiscard]] std::string AlignmentFileText(const ImportedLine& line,
                                            const MapProjection& projection);

/// A track and a structure as scenario files have them, without keys that have their defaults.
[[nodiscard]] Json JsonOf(TrackSpec track);
[[nodiscard]] Json JsonOf(StructureSpec structure);

/// The world as a file that a scenario may name, with one item to a line of text.
/// @param has_elevation Whether NAME.elevation.asc stands beside it.
[[nodiscard]] std::string WorldFileText(const ImportedLine& line,
                                        const LineWorld& world,
                                        bool has_elevation);

/// Writes a line's alignment and its world.
void WriteLine(const std::filesystem::path& out,
               const ImportedLine& line,
               const MapProjection& projection,
               const LineWorld& world,
               bool has_elevation);

/// All contradictions as CSV.
[[nodiscard]] std::string ContradictionsCsv(const std::vector<ImportedLine>& lines);

/// What was not taken as it is.
struct LeftOutOfMap {
  std::vector<Remark> remarks;  ///< About the map and its heights.
  std::vector<LeftOutLine> lines;
};

/// What was left out as CSV: of the map, whole lines, then what worlds lack.
[[nodiscard]] std::string LeftOutCsv(const LeftOutOfMap& left_out,
                                     const std::vector<ImportedLine>& lines,
                                     const std::vector<LineWorld>& worlds);

/// All rows of a kind as one; its reasons are without the names of tracks.
[[nodiscard]] AccountRow SumOf(const std::vector<AccountRow>& rows, const std::string& what);

/// Writes the tables in CSV: what became of the map, and how close lines and tracks are to it.
void WriteTables(const std::filesystem::path& out,
                 const std::vector<ImportedLine>& lines,
                 const std::vector<LineWorld>& worlds,
                 const std::vector<AccountRow>& account,
                 const LeftOutOfMap& left_out);

/// The same in short, to be read: the qualities of lines, the sums of the account with the greatest
/// losses, how much was moved, and which lines were left out.
[[nodiscard]] std::string TablesText(const std::vector<ImportedLine>& lines,
                                     const std::vector<LineWorld>& worlds,
                                     const std::vector<AccountRow>& account,
                                     const std::vector<LeftOutLine>& left_out);

}  // namespace railcast
