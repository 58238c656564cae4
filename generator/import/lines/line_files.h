#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/scenario/json_text.h"
#include "generator/import/lines/imported_line.h"
#include "generator/import/map/map_projection.h"

namespace railcast {

/// JSON as text, with one item of a list of lists or objects to a line.
[[nodiscard]] std::string TextWithItems(const Json& json);

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

}  // namespace railcast
