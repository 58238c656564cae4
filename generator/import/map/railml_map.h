#pragma once

#include <filesystem>
#include <string_view>

#include "generator/import/map/rail_map.h"

namespace railcast {

/// Whether a file begins as railML 3 does.
[[nodiscard]] bool IsRailMl(std::string_view begin);

/// Reads the tracks of a railML 3 file: net elements with coordinates in a geometric positioning
/// system, whatever its coordinate system, and the speed sections on them.
///
/// A net element is a way through its coordinates, in order of `intrinsicCoord`; `z` is its height.
/// Net elements without coordinates, as upper levels of the topology have none, are left out. Speed
/// sections divide the ways where they begin and end.
/// @throws InputError with a line for each fault.
[[nodiscard]] RailMap ReadRailMl(const std::filesystem::path& file);

}  // namespace railcast
