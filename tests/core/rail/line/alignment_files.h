#pragma once

#include <filesystem>

#include "core/rail/line/alignment_spec.h"

namespace railcast {

/// Our own file of the real line St.Gallen - Wil, read without any check.
[[nodiscard]] AlignmentSpec ReadStGallenWil();

/// A file of TTOBench, with our sign of radii.
[[nodiscard]] AlignmentSpec ReadTtobench(const std::filesystem::path& file);

}  // namespace railcast
