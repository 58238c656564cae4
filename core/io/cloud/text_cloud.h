#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/cloud/cloud.h"

namespace railcast {

/// The endings of clouds in text, for messages; .txt and .csv are among them only where
/// `with_tables`.
[[nodiscard]] std::vector<std::string> TextCloudEndings(bool with_tables);

/// Whether a file's name ends in .xyz, .pts, .asc, .pc, .txt or .csv, in any case.
[[nodiscard]] bool IsTextCloud(const std::filesystem::path& file);

/// Whether it ends in .txt or .csv: such files are clouds where they are named, but no frames of a
/// folder, in which they stand beside clouds as tables.
[[nodiscard]] bool IsTextTable(const std::filesystem::path& file);

/// Whether it is a list of names for the columns of text, "x,y,z,intensity": x, y and z, and others
/// at most once each, of letters, digits, dots and underscores. "_" is a column that is not used.
[[nodiscard]] bool IsTextColumns(std::string_view choice);

/// Reads a cloud in text: a line of numbers for each point, between blanks, commas or semicolons.
/// Before them may stand, in any order, the number of points alone in a line, the names of columns
/// (bare, or behind # or //) and comments. Names are in lower case, without their units. Columns
/// are float32, or float64 if they are times or have digits that float32 cannot hold
/// (Cloud::WidenRounded()). Without names, the first three are x, y and z, and a remark tells of
/// others. Empty fields and "-" are NaN.
/// @param columns IsTextColumns(), the names in place of those of the file; empty = none are
/// chosen.
/// @throws InputError "file: line N: rule (got value)" if a line has another number of columns, its
///   position is no number, there is another number of lines than stated, or a unit is not metres.
[[nodiscard]] Cloud ParseTextCloud(const std::string& file,
                                   std::string bytes,
                                   const std::string& columns = {});

/// As ParseTextCloud(), of a file.
[[nodiscard]] Cloud ReadTextCloud(const std::filesystem::path& file,
                                  const std::string& columns = {});

}  // namespace railcast
