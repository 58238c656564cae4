#pragma once

#include <filesystem>

#include "generator/import/map/rail_map.h"

namespace railcast {

/// Reads the tracks of a vector file with GDAL: OpenStreetMap's .osm and .pbf, GeoJSON, GPX, KML.
///
/// If any line has a key `railway`, only those are taken that are tracks (IsTrack); otherwise all
/// lines are. Lines meet where they share a point, to the last digit. Attributes become tags.
/// @throws InputError if GDAL cannot read the file, if it has no line or has a polygon as a track,
///   or if its coordinates are no degrees.
[[nodiscard]] RailMap ReadVectorMap(const std::filesystem::path& file);

}  // namespace railcast
