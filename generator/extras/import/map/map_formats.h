#pragma once

#include <cmath>
#include <filesystem>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/text_number.h"
#include "core/scenario/json_text.h"
#include "generator/extras/import/map/rail_map.h"

namespace railcast {

/// Opens a map. What gzip or bzip2 packed, as its first bytes say, is unpacked while it is read,
/// with all of its members.
/// @throws InputError as OpenInput() does. Reading throws it, too: if packed data are damaged, end
///   early or have anything behind them, or if they unpack to more than 64 MiB and 100 times their
///   size, as no map does.
[[nodiscard]] std::unique_ptr<std::istream> OpenMap(const std::filesystem::path& file);
[[nodiscard]] bool IsPacked(const std::filesystem::path& file);

/// A whole map, unpacked, AsUtf8().
/// @throws InputError as OpenMap() and reading do.
[[nodiscard]] std::string ReadMapText(const std::filesystem::path& file);

/// Whether JSON is nested deeper than ParseJson() takes it, which is slower than to look first.
[[nodiscard]] inline bool IsNestedDeep(std::string_view json) {
  constexpr int kDeepest = 64;
  int depth = 0;
  bool is_text = false;
  for (std::size_t i = 0; i < json.size() && depth <= kDeepest; ++i) {
    if (is_text && json[i] == '\\')
      ++i;  // Passes over what it escapes.
    else if (json[i] == '"')
      is_text = !is_text;
    else if (!is_text && (json[i] == '{' || json[i] == '['))
      ++depth;
    else if (!is_text && (json[i] == '}' || json[i] == ']'))
      --depth;
  }
  return depth > kDeepest;
}

/// @throws InputError if the file cannot be read, is no JSON or is nested deeper than 64 levels.
[[nodiscard]] inline Json ReadMapJson(const std::filesystem::path& file) {
  const std::string text = ReadMapText(file);
  try {
    if (!IsNestedDeep(text)) return Json::parse(text);
  } catch (const Json::exception&) {
    // It is parsed again for the place.
  }
  throw InputError(ShownPath(file) + ": must be JSON: " + ParseJson(text).syntax_error);
}

/// The number that a text is; absent if it is anything else, or not finite.
[[nodiscard]] inline std::optional<double> NumberIn(std::string_view text) {
  const std::optional<double> value = ParseTextNumber<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

inline constexpr double kMostLongitude_deg = 180.0;
inline constexpr double kMostLatitude_deg = 90.0;

/// What a longitude or latitude of a source must be.
[[nodiscard]] inline std::string DegreesRule(double most_deg) {
  return "must be a number of degrees from " + NumberText(-most_deg) + " to " +
         NumberText(most_deg);
}

// The formats among which ReadMap() chooses. OpenStreetMap's are alike (OsmMapMaker), and so are
// those of plain lines (MapOfLines).

/// Reads the railway ways of an answer of OpenStreetMap's Overpass API in JSON, with their nodes
/// (`out body; >; out skel;`) or with their geometry (`out geom;`).
/// @throws InputError for each fault, with JSON pointers: a remark that the answer is not whole, no
///   elements, coordinates that are no degrees, and as OsmMapMaker does.
[[nodiscard]] RailMap ReadOverpassJson(const std::filesystem::path& file);

/// Reads OpenStreetMap's .osm.pbf with blobs that are zlib, lz4 or plain; ways may have the places
/// of their nodes.
/// @throws InputError if the file is damaged or ends early, with the number of the block, or needs
///   what is not read, and as OsmMapMaker does.
[[nodiscard]] RailMap ReadOsmPbf(const std::filesystem::path& file);
[[nodiscard]] bool IsOsmPbf(std::string_view begin);

/// Reads a map in XML: OpenStreetMap's (also of Overpass, `out geom;` too), GPX, KML or railML 3.
/// @throws InputError for each fault, with its line: XML that ends early, another root element,
///   longitudes and latitudes that are no degrees, heights that are no numbers, and as OsmMapMaker
///   and MapOfLines do.
[[nodiscard]] RailMap ReadXmlMap(const std::filesystem::path& file);

/// Reads the lines of GeoJSON.
/// @throws InputError for each fault, with JSON pointers: text that is no JSON, another coordinate
///   system than WGS 84, coordinates that are no numbers, and as MapOfLines does.
[[nodiscard]] RailMap ReadGeoJson(const std::filesystem::path& file);

}  // namespace railcast
