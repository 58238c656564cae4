#pragma once

#include <filesystem>

namespace railcast {

/// Checks the places of a GeoJSON file. GDAL, which reads it, drops a line of which a coordinate is
/// no number.
/// @throws InputError for each fault, with JSON pointers: text that is no JSON, coordinates that
///   are no numbers, heights of some points of a line but not of all.
void CheckGeoJsonPlaces(const std::filesystem::path& file);

}  // namespace railcast
