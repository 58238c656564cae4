#pragma once

#include <filesystem>
#include <functional>

#include "analysis/verify/verification.h"

namespace railcast {

/// Compares every file of a data set with its manifest.json and scenarios.jsonl, verifies every
/// sequence, and looks for files and sequences that these do not name. A shard has no manifest, and
/// is whole if it has all its scenarios.
/// @param on_progress Called from time to time with the completed share.
/// @throws InputError if dataset.json cannot be read.
[[nodiscard]] Verification VerifyDataset(const std::filesystem::path& directory,
                                         const std::function<void(double)>& on_progress);

}  // namespace railcast
