#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/io/write_file.h"
#include "generator/extras/import/heights/elevation_map.h"
#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/map/map_projection.h"
#include "generator/extras/import/map/read_map.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/fuzz/fault_lines.h"
#include "tests/fuzz/fuzz_target.h"

namespace railcast {
namespace {

void CheckMap(const RailMap& map) {
  Check(!map.ways.empty(), "a map has a track");
  for (const MapWay& way : map.ways) {
    Check(way.nodes.size() >= 2, "a way has two nodes");
    for (std::size_t i = 0; i < way.nodes.size(); ++i) {
      Check(way.nodes[i] < map.nodes.size(), "a node is of the map");
      Check(i == 0 || way.nodes[i] != way.nodes[i - 1], "neighbours differ");
    }
  }
  for (const MapThing& thing : map.things) {
    Check(!thing.geographic_deg.empty(), "a thing is somewhere");
  }
}

void ReadMapFile(const std::filesystem::path& file) {
  RailMap map = ReadMap(file);
  CheckMap(map);
  static_cast<void>(ProjectMap("", map));
  for (const TrackLine& line : FindLines(map, 0.0)) {
    Check(line.ways.size() + 1 == line.nodes.size(), "a way is between two nodes");
    Check(LengthOf_m(map, line) > 0.0, "a line has a length");
  }
}

void ReadElevationFile(const std::filesystem::path& file) {
  const MapProjection metres{.definition = "EPSG:32633", .origin_m = {500000.0, 5340000.0}};
  const Eigen::AlignedBox2d bounds_m(Eigen::Vector2d(-50.0, -50.0), Eigen::Vector2d(50.0, 50.0));
  const ElevationMap elevation(file, "EPSG:32633", metres, bounds_m);
  Check(ElevationGridText(elevation, bounds_m).starts_with("ncols "), "a grid is written");
}

const char* ExtensionOf(char kind) {
  switch (kind) {
    case 'j':
      return "json";
    case 'g':
      return "geojson";
    case 'x':
      return "gpx";
    case 'k':
      return "kml";
    case 'o':
      return "osm";
    case 'p':
      return "osm.pbf";
    case 'a':
      return "asc";
    default:
      return "xml";
  }
}

void ReadBytes(char kind, std::string_view bytes) {
  static const TemporaryDirectory directory;
  const std::filesystem::path file = directory.path() / (std::string("map.") + ExtensionOf(kind));
  WriteFileWhole(file, bytes);
  try {
    if (kind == 'a') {
      ReadElevationFile(file);
    } else {
      ReadMapFile(file);
    }
  } catch (const InputError& error) {
    CheckFaultLines(error.what());
  }
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace railcast

/// Entry point for libFuzzer. The first byte selects the format: j Overpass JSON, g GeoJSON, x GPX,
/// k KML, o OpenStreetMap's XML, p its PBF, a an ESRI ASCII grid, anything else railML.
RAILCAST_FUZZ_TARGET(map) {
  if (size == 0) return 0;
  railcast::ReadBytes(static_cast<char>(data[0]),
                      {reinterpret_cast<const char*>(data) + 1, size - 1});
  return 0;
}
