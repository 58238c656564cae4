#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "analysis/report/report.h"
#include "core/extras/recipe/dataset_report_record.h"

namespace railcast {

/// The words of cards (report/words.h).
extern const char* const kCardWords;

/// What a finished data set says of itself in manifest.json and report.json (docs/dataset.md).
struct DatasetOverview {
  std::filesystem::path source;
  std::string data_hash;
  std::uint64_t num_scenarios{};
  DatasetReportRecord report;
};

/// Reads both files.
/// @throws InputError with one line if a file cannot be read, has changed since it was written, or
///   is not what railcast-generate writes.
[[nodiscard]] DatasetOverview ReadDatasetOverview(const std::filesystem::path& directory);

/// Reads a file that is named in a finished data set's manifest.json.
/// @param name Relative to the data set: "recipe.json".
/// @throws InputError as ReadDatasetOverview() does.
[[nodiscard]] std::string ReadDatasetFile(const std::filesystem::path& directory,
                                          std::string_view name);

/// The section of a data set: balance of its classes, objects by type, distance and occlusion,
/// weathers, parts, bases and sensors. Defined in dataset_section.cpp.
/// @param suffix Follows the keys of section, charts and tables; "" for the first data set of a
///   report, "_2" for the second.
[[nodiscard]] Section MakeDatasetSection(const DatasetOverview& overview,
                                         const std::string& suffix);

}  // namespace railcast
