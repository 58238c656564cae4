#pragma once

#include <filesystem>

#include "generator/import/map/rail_map.h"

namespace railcast {

/// Reads the railway ways of an answer of OpenStreetMap's Overpass API in JSON, with their nodes
/// (`out body; >; out skel;`) or with their geometry (`out geom;`). A way or a node that appears
/// twice is taken once. Ways that are not tracks (`railway=platform`, ...) and relations are left
/// out.
/// @throws InputError for each fault, with JSON pointers: no elements, coordinates that are no
///   degrees, a way whose node is missing, a node in two places, no track at all.
[[nodiscard]] RailMap ReadOverpassJson(const std::filesystem::path& file);

}  // namespace railcast
