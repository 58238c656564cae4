#pragma once

#include <string_view>

namespace railcast {

// The files of the clouds of all sensors of a run together (docs/files.md), in a folder beside
// those of the sensors.

inline constexpr std::string_view kMergedFolder = "merged";
/// Names the clouds, what they are made of and their hashes, a line for each. Relative to the
/// folder.
inline constexpr std::string_view kMergedFile = "merged.jsonl";
/// The field that tells from which sensor a point is: its place in sensors.json.
inline constexpr std::string_view kSensorIndexField = "sensor_index";

}  // namespace railcast
