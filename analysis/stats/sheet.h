#pragma once

#include <filesystem>
#include <vector>

#include "analysis/report/report.h"

namespace railcast {

/// Makes a sheet of pictures of recordings: a row for each sensor, by its name, and for each
/// camera, of frames spread evenly over all its recordings.
/// @throws InputError if a recording cannot be read.
[[nodiscard]] Picture MakeSheet(const std::vector<std::filesystem::path>& recordings);

}  // namespace railcast
