#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/extras/recipe/shard.h"
#include "core/io/recording/line_reader.h"
#include "core/io/run/sensors_record.h"
#include "core/io/verify/verification.h"

namespace railcast {

/// Which scenarios the folder of a data set holds, as its dataset.json says.
struct DatasetContent {
  std::uint32_t num_scenarios{};  ///< Scenarios of the whole data set.
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

/// Compares the folder of a scenario of a data set with its line of scenarios.jsonl: verifies its
/// sequences, compares them with what the line says of them, and looks for files that belong to
/// none.
/// @param dataset The folder of the data set.
/// @param scenario The number that the line must have.
[[nodiscard]] Verification VerifyScenario(const std::filesystem::path& dataset,
                                          std::uint32_t scenario,
                                          const PlacedLine& line);

}  // namespace railcast
