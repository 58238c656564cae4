#include "generator/extras/import/map/read_map.h"

#include <geodesic.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/base/unread_formats.h"
#include "generator/extras/import/map/map_formats.h"

namespace railcast {
namespace {

constexpr std::size_t kNotKept = std::numeric_limits<std::size_t>::max();

/// Appends the runs of a way's points that are kept.
void AppendRuns(const MapWay& way, const std::vector<std::size_t>& kept, RailMap& cropped) {
  MapWay run{way.id, {}, way.tags, way.place};
  const auto end_run = [&] {
    if (run.nodes.size() >= 2) cropped.ways.push_back(run);
    run.nodes.clear();
  };
  for (const std::size_t node : way.nodes) {
    if (kept[node] == kNotKept) {
      end_run();
    } else {
      run.nodes.push_back(kept[node]);
    }
  }
  end_run();
}

std::string BytesAtBegin(const std::filesystem::path& file) {
  std::array<char, 4096> bytes{};
  const std::unique_ptr<std::istream> stream = OpenMap(file);
  stream->read(bytes.data(), bytes.size());
  return {bytes.data(), static_cast<std::size_t>(stream->gcount())};
}

/// The first character of a text but blanks; 0 if there is none.
char FirstOf(std::string_view begin) {
  const std::size_t first = begin.find_first_not_of(" \t\r\n");
  return first == std::string_view::npos ? '\0' : begin[first];
}

/// GeoJSON is JSON, too, and may have a property `elements`, but it begins with what it is.
bool IsOverpass(std::string_view begin) {
  return FirstOf(begin) == '{' && begin.find("\"elements\"") != std::string_view::npos &&
         begin.find("\"Feature\"") == std::string_view::npos &&
         begin.find("\"FeatureCollection\"") == std::string_view::npos;
}

/// Whether a file says in its first lines that it is of OpenStreetMap, as exports do.
bool NamesOpenStreetMap(std::string begin) {
  std::ranges::transform(begin, begin.begin(), [](char letter) {
    return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  });
  return begin.find("openstreetmap") != std::string::npos;
}

/// How to convert a file of another format. What is packed is no such file, nor is what has only
/// kept its name after it was unpacked.
std::string AdviceOnOther(const std::filesystem::path& file) {
  const std::string ending = LowerCase(file.extension().string());
  return IsPacked(file) || ending == ".gz" || ending == ".bz2" ? "" : AdviceOnFile(file);
}

RailMap ReadAnyMap(const std::filesystem::path& file) {
  const std::string bytes = BytesAtBegin(file);
  if (IsOsmPbf(bytes)) return ReadOsmPbf(file);
  if (const std::string advice = AdviceOnOther(file); !advice.empty()) {
    throw InputError(ShownPath(file) + ": " + advice);
  }
  const std::string begin = AsUtf8(bytes);
  if (IsOverpass(begin)) return ReadOverpassJson(file);
  if (FirstOf(begin) != '<' && FirstOf(begin) != '{') {
    throw InputError(ShownPath(file) +
                     ": must be a map: Overpass JSON, .osm, .pbf, GeoJSON, GPX, KML or railML 3, "
                     "also as .gz or .bz2" +
                     (bytes.empty() ? " (got nothing)" : ""));
  }
  RailMap map = FirstOf(begin) == '<' ? ReadXmlMap(file) : ReadGeoJson(file);
  if (NamesOpenStreetMap(begin)) map.attribution = kOpenStreetMapAttribution;
  return map;
}

/// The longest straights of railways are mapped with points every few kilometres: what is farther
/// apart is a slip of the pen.
constexpr double kFarthestNeighbours_m = 50e3;

void CheckNeighbours(const RailMap& map) {
  geod_geodesic wgs84{};
  geod_init(&wgs84, 6378137.0, 1.0 / 298.257223563);
  ErrorList errors;
  for (const MapWay& way : map.ways) {
    for (std::size_t i = 1; i < way.nodes.size(); ++i) {
      const Eigen::Vector2d& a_deg = map.nodes[way.nodes[i - 1]].geographic_deg;
      const Eigen::Vector2d& b_deg = map.nodes[way.nodes[i]].geographic_deg;
      double apart_m = 0.0;
      geod_inverse(&wgs84, a_deg.y(), a_deg.x(), b_deg.y(), b_deg.x(), &apart_m, nullptr, nullptr);
      if (apart_m <= kFarthestNeighbours_m) continue;
      errors.Add({"track from " + NumberText(a_deg.x()) + ", " + NumberText(a_deg.y()) + " to " +
                      NumberText(b_deg.x()) + ", " + NumberText(b_deg.y()) + " degrees",
                  "must have points at most 50 km apart",
                  NumberText(std::round(1e-3 * apart_m)) + " km"});
    }
  }
  errors.ThrowIfAny();
}

/// A rectangle without railways: the World Factbook names none in Somalia, Yemen and Oman, and
/// those of their neighbours end west or north of it. It is where central Europe would be if its
/// longitudes were latitudes.
const Eigen::AlignedBox2d kNoRailways_deg{Eigen::Vector2d(43.5, -1.5), Eigen::Vector2d(60.0, 20.0)};

void CheckIsWhereRailwaysAre(const RailMap& map) {
  for (const MapWay& way : map.ways) {
    const Eigen::Vector2d& place_deg = map.nodes[way.nodes.front()].geographic_deg;
    if (!kNoRailways_deg.contains(place_deg)) continue;
    throw InputError({Fault{
        "track at " + NumberText(place_deg.x()) + ", " + NumberText(place_deg.y()) + " degrees",
        "must be where railways are, not between Somalia and Oman: longitudes "
        "and latitudes are likely exchanged",
        ""}});
  }
}

}  // namespace

RailMap CropMap(const RailMap& map, const Eigen::AlignedBox2d& within_deg) {
  RailMap cropped;
  cropped.attribution = map.attribution;
  cropped.remarks = map.remarks;
  std::vector<std::size_t> kept(map.nodes.size(), kNotKept);
  for (std::size_t i = 0; i < map.nodes.size(); ++i) {
    if (!within_deg.contains(map.nodes[i].geographic_deg)) continue;
    kept[i] = cropped.nodes.size();
    cropped.nodes.push_back(map.nodes[i]);
  }
  for (const MapWay& way : map.ways) AppendRuns(way, kept, cropped);
  for (const MapThing& thing : map.things) {
    const bool is_inside = std::ranges::all_of(thing.geographic_deg, [&](const auto& place_deg) {
      return within_deg.contains(place_deg);
    });
    if (is_inside) cropped.things.push_back(thing);
  }
  // What is said of a way goes with it.
  std::set<std::string_view> gone;
  for (const MapWay& way : map.ways) gone.insert(way.place);
  for (const MapWay& way : cropped.ways) gone.erase(way.place);
  gone.erase("");
  std::erase_if(cropped.remarks, [&](const Remark& it) { return gone.contains(it.place); });
  return cropped;
}

RailMap ReadMap(const std::filesystem::path& file) {
  RailMap map;
  try {
    map = ReadAnyMap(file);
  } catch (const InputError&) {
    // Damaged packing makes the map look wrong, too; then it is the damage that is told.
    if (IsPacked(file)) OpenMap(file)->ignore(std::numeric_limits<std::streamsize>::max());
    throw;
  }
  AtPlace(ShownPath(file) + ": ", [&] {
    CheckNeighbours(map);
    CheckIsWhereRailwaysAre(map);
  });
  return map;
}

}  // namespace railcast
