#pragma once

#include <filesystem>

#include "generator/import/map/rail_map.h"

namespace railcast {

/// Reads a map in any of the formats that import takes, which is told by its content.
/// @throws InputError as ReadOverpassJson and ReadVectorMap do.
[[nodiscard]] RailMap ReadMap(const std::filesystem::path& file);

}  // namespace railcast
