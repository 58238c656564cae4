#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/report/report.h"
#include "core/io/run/dataset_files.h"

namespace railcast {

/// What a finished data set says of itself in manifest.json and report.json (docs/dataset.md). All
/// lists are in the order of the file.
struct DatasetOverview {
  /// Numbers by name.
  using Counts = std::vector<std::pair<std::string, std::uint64_t>>;

  struct Part {
    std::string name;  ///< "train", "val" or "test".
    std::uint64_t scenarios{};
    std::uint64_t frames{};
    std::uint64_t points{};
  };
  struct Class {
    std::string label;
    std::uint64_t points{};
    std::uint64_t frames{};  ///< Frames with such a point.
  };
  /// Objects of one type. All but `objects` count an object in each frame.
  struct TypeCounts {
    std::string name;
    std::uint64_t objects{};  ///< Distinct ones.
    std::uint64_t in_frames{};
    std::uint64_t with_points{};
    std::uint64_t points{};
    std::array<std::uint64_t, kNumDistanceBins> by_distance{};
    std::array<std::uint64_t, kNumDistanceBins> points_by_distance{};
    std::array<std::uint64_t, kNumOcclusionBins> by_occlusion{};
  };

  std::filesystem::path source;
  std::string data_hash;
  std::uint64_t num_scenarios{};
  std::uint64_t num_frames{};
  std::uint64_t num_points{};
  std::uint64_t frames_without_points{};
  std::uint64_t frames_without_objects{};
  std::uint64_t duplicate_frames{};  ///< Of frames with the same bytes, all but one.
  std::vector<Part> parts;
  std::vector<Class> classes;
  std::vector<TypeCounts> types;
  Counts weathers;                                    ///< Scenarios.
  std::vector<std::pair<std::string, Counts>> drawn;  ///< Scenarios by the words of each draw.
  Counts frames_by_base;
  Counts frames_by_sensor;
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
