#pragma once

#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/write_file.h"
#include "core/scenario/json_text.h"
#include "generator/import/map/rail_map.h"

namespace railcast {

/// @throws InputError if the file cannot be read or is no JSON.
[[nodiscard]] inline Json ReadMapJson(const std::filesystem::path& file) {
  const std::string text = ReadFileWhole(file);
  try {
    return Json::parse(text);
  } catch (const Json::exception&) {
    throw InputError(ShownPath(file) + ": must be JSON: " + ParseJson(text).syntax_error);
  }
}

/// The number that a text is; absent if it is anything else, or not finite.
[[nodiscard]] inline std::optional<double> NumberIn(std::string_view text) {
  const std::optional<double> value = ParseNumber<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

inline constexpr double kMostLongitude_deg = 180.0;
inline constexpr double kMostLatitude_deg = 90.0;

/// What a longitude or latitude of a source must be.
[[nodiscard]] inline std::string DegreesRule(double most_deg) {
  return "must be a number of degrees from " + NumberText(-most_deg) + " to " +
         NumberText(most_deg);
}

// The formats among which ReadMap() chooses.

/// Reads the railway ways of an answer of OpenStreetMap's Overpass API in JSON, with their nodes
/// (`out body; >; out skel;`) or with their geometry (`out geom;`). A way or a node that appears
/// twice is taken once. Ways that are not tracks (`railway=platform`, ...) and relations are left
/// out.
/// @throws InputError for each fault, with JSON pointers: no elements, coordinates that are no
///   degrees, a way whose node is missing, a node in two places, no track at all.
[[nodiscard]] RailMap ReadOverpassJson(const std::filesystem::path& file);

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

/// Reads the tracks of a vector file with GDAL: OpenStreetMap's .osm and .pbf, GeoJSON, GPX, KML.
///
/// If any line has a key `railway`, and always in OpenStreetMap's formats, only those are taken
/// that are tracks (IsTrack); otherwise all lines are. Lines meet where they share a point, to the
/// last digit. Attributes become tags.
/// @throws InputError if GDAL cannot read the file to its end, if it has no line, if a track is a
///   polygon or has no two different points, or if its coordinates are no degrees.
[[nodiscard]] RailMap ReadVectorMap(const std::filesystem::path& file);

/// Checks the places of a GeoJSON file. GDAL, which reads it, drops a line of which a coordinate is
/// no number.
/// @throws InputError for each fault, with JSON pointers: text that is no JSON, coordinates that
///   are no numbers, heights of some points of a line but not of all.
void CheckGeoJsonPlaces(const std::filesystem::path& file);

/// Checks the places in the text of a map in XML: OpenStreetMap's, GPX or KML. GDAL, which reads
/// these maps, takes 0 for what is no number and for a height that is missing.
/// @throws InputError for each fault, with its line: XML that ends early, longitudes and latitudes
///   that are no degrees, heights that are no numbers, heights of some points of a line but not of
///   all, two nodes or ways of one id.
void CheckXmlPlaces(const std::filesystem::path& file);

}  // namespace railcast
