#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/stats/dataset_overview.h"
#include "railcast/io/recording.h"

namespace railcast {

/// A source that `stats` was given, and what it consists of.
struct MeasuredSource {
  std::filesystem::path source;
  std::vector<std::filesystem::path> recordings;  ///< In their order; the source itself if one.
  /// What reports call a source whose recordings they do not list, such as "shard 1/3 of a data
  /// set"; else empty.
  std::string kind{};
  std::optional<DatasetOverview> overview{};  ///< Of a data set that is no shard.
};

/// Looks what a path leads to: the sequences of a data set, of several sensors or of KITTI's
/// layout, or a single recording.
/// @throws InputError with one line if it is an unfinished or damaged data set.
[[nodiscard]] MeasuredSource LookAtSource(const std::filesystem::path& source);

/// The description of a whole source, for reports that do not list its recordings one by one.
/// @param first The description of the first recording of the source.
[[nodiscard]] RecordingInfo InfoOfWhole(const MeasuredSource& whole, const RecordingInfo& first);

}  // namespace railcast
