#pragma once

#include <filesystem>
#include <functional>

#include "core/io/verify/verification.h"

namespace railcast {

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
