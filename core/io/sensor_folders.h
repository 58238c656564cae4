#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace railcast {

/// The file that names the folders of several sensors' sequences of one run.
inline constexpr std::string_view kSensorsFile = "sensors.json";

/// The folders that a directory's sensors.json names, in its order; none if it has no such file.
/// @throws InputError if the file is not what railcast-generate sequence writes.
[[nodiscard]] std::vector<std::filesystem::path> SensorFoldersIn(
    const std::filesystem::path& directory);

}  // namespace railcast
