#pragma once

#include <filesystem>

#include "generator/import/map/rail_map.h"

namespace railcast {

/// Reads the tracks of a vector file with GDAL: OpenStreetMap's .osm and .pbf, GeoJSON, GPX, KML.
///
/// If any line has a key `railway`, and always in OpenStreetMap's formats, only those are taken
/// that are tracks (IsTrack); otherwise all lines are. Lines meet where they share a point, to the
/// last digit. Attributes become tags.
/// @throws InputError if GDAL cannot read the file to its end, if it has no line, if a track is a
///   polygon or has no two different points, or if its coordinates are no degrees.
[[nodiscard]] RailMap ReadVectorMap(const std::filesystem::path& file);

}  // namespace railcast
