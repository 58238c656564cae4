#pragma once

#include <filesystem>
#include <functional>

#include "core/io/verify/verification.h"

namespace railcast {

/// Compares every file of a recording into which something was put, or that was converted, with
/// run.json, manifest.json and insert.jsonl or convert.jsonl, and looks for files that these do not
/// name. A recording in it that is a sequence is verified as one.
/// @param on_progress Called from time to time with the completed share.
/// @throws InputError if the directory is none.
[[nodiscard]] Verification VerifyInsertion(const std::filesystem::path& directory,
                                           const std::function<void(double)>& on_progress);

}  // namespace railcast
