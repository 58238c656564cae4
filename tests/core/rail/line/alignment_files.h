#pragma once

#include <filesystem>

#include "railcast/alignment.h"

namespace railcast {

/// Reads railcast's own file of the real line St.Gallen - Wil without any checks.
[[nodiscard]] AlignmentSpec ReadStGallenWil();

/// Reads a TTOBench file and converts radii to railcast's sign convention.
[[nodiscard]] AlignmentSpec ReadTtobench(const std::filesystem::path& file);

}  // namespace railcast
