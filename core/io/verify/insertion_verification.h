#pragma once

#include <filesystem>
#include <functional>

#include "core/io/verify/verification.h"

namespace railcast {

/// Whether a directory holds a recording into which something was put.
[[nodiscard]] bool IsInsertion(const std::filesystem::path& directory);

/// Compares every file of such a directory with run.json, manifest.json and insert.jsonl, and looks
/// for files that these do not name. A recording in it that is a sequence is verified as one.
/// @param on_progress Called from time to time with the completed share.
/// @throws InputError if the directory is none.
[[nodiscard]] Verification VerifyInsertion(const std::filesystem::path& directory,
                                           const std::function<void(double)>& on_progress);

}  // namespace railcast
