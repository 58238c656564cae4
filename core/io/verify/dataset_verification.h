#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/io/run/dataset_files.h"
#include "core/io/verify/verification.h"

namespace railcast {

/// Which scenarios the folder of a data set holds, as its dataset.json says.
struct DatasetContent {
  std::uint32_t num_scenarios{};  ///< Of the whole data set.
  std::string recipe_hash;
  Shard shard;

  /// Number of scenarios of this folder.
  [[nodiscard]] std::uint32_t num_own() const { return shard.NumOf(num_scenarios); }
};

/// Whether a folder holds a data set of `railcast-generate dataset`, or a shard of one.
[[nodiscard]] bool IsDataset(const std::filesystem::path& directory);

/// @throws InputError with one line if dataset.json cannot be read.
[[nodiscard]] DatasetContent ReadDatasetContent(const std::filesystem::path& directory);

/// The folders of a finished data set's sequences, in order.
/// @throws InputError with one line if the data set, or one of its sequences, is unfinished.
[[nodiscard]] std::vector<std::filesystem::path> FinishedSequences(
    const std::filesystem::path& directory, const DatasetContent& content);

/// Compares every file of a data set with its manifest.json and scenarios.jsonl, verifies every
/// sequence, and looks for files and sequences that these do not name.
/// @param on_progress Called from time to time with the completed share.
/// @throws InputError if dataset.json cannot be read.
[[nodiscard]] Verification VerifyDataset(const std::filesystem::path& directory,
                                         const std::function<void(double)>& on_progress);

/// Compares the files about all scenarios with the manifest.json of a data set or a shard.
/// @throws InputError if dataset.json cannot be read.
[[nodiscard]] Verification VerifyDatasetFiles(const std::filesystem::path& directory);

}  // namespace railcast
