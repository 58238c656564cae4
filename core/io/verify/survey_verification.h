#pragma once

#include <filesystem>

#include "core/io/verify/verification.h"

namespace railcast {

/// Whether a directory holds a survey, as railcast-generate survey makes it.
[[nodiscard]] bool IsSurvey(const std::filesystem::path& directory);

/// Compares the files of such a directory with survey.json, and looks for files that it does not
/// name.
/// @throws InputError if the directory cannot be read.
[[nodiscard]] Verification VerifySurvey(const std::filesystem::path& directory);

}  // namespace railcast
