#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "core/io/run/sequence_files.h"

namespace railcast {

/// The file that names the folders of several sensors' sequences of one run.
inline constexpr std::string_view kSensorsFile = "sensors.json";

/// The folders that a directory's sensors.json names, in its order; none if it has no such file.
/// @throws InputError if the file is not what railcast-generate sequence writes.
[[nodiscard]] std::vector<std::filesystem::path> SensorFoldersIn(
    const std::filesystem::path& directory);

/// The folder of the merged clouds that a directory's sensors.json names, and its files' hashes.
struct MergedFolder {
  std::filesystem::path folder;
  std::vector<KnownFile> files;  ///< Relative to the folder.
};

/// @return Nothing if sensors.json names none.
/// @throws InputError as SensorFoldersIn() does.
[[nodiscard]] std::optional<MergedFolder> MergedFolderIn(const std::filesystem::path& directory);

}  // namespace railcast
