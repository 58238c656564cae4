#pragma once

#include <filesystem>

namespace railcast {

/// Checks the places in the text of a map in XML: OpenStreetMap's, GPX or KML. GDAL, which reads
/// these maps, takes 0 for what is no number and for a height that is missing.
/// @throws InputError for each fault, with its line: XML that ends early, longitudes and latitudes
///   that are no degrees, heights that are no numbers, heights of some points of a line but not of
///   all, two nodes or ways of one id.
void CheckXmlPlaces(const std::filesystem::path& file);

}  // namespace railcast
