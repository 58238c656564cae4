#include "generator/import/map/map_formats.h"

#include <cpl_conv.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "generator/import/map/gdal_errors.h"

namespace railcast {
namespace {

/// "name"=>"value" pairs, as GDAL gives the tags for which it has no column.
void AddOtherTags(std::string_view text, MapTags& tags) {
  const auto quoted = [&]() -> std::optional<std::string> {
    const std::size_t begin = text.find('"');
    if (begin == std::string_view::npos) return std::nullopt;
    std::string value;
    std::size_t i = begin + 1;
    for (; i < text.size() && text[i] != '"'; ++i) {
      if (text[i] == '\\' && i + 1 < text.size()) ++i;
      value += text[i];
    }
    text.remove_prefix(std::min(i + 1, text.size()));
    return value;
  };
  while (auto key = quoted()) {
    const auto value = quoted();
    if (!value) return;
    tags.emplace(*std::move(key), *value);
  }
}

MapTags FeatureTags(const OGRFeature& feature) {
  MapTags tags;
  for (int i = 0; i < feature.GetFieldCount(); ++i) {
    if (!feature.IsFieldSetAndNotNull(i)) continue;
    const char* key = feature.GetFieldDefnRef(i)->GetNameRef();
    const char* value = feature.GetFieldAsString(i);
    if (EQUAL(key, "other_tags")) {
      AddOtherTags(value, tags);
    } else if (*value != '\0') {
      // KML calls a line's name Name, GPX name.
      tags.emplace(EQUAL(key, "name") ? "name" : key, value);
    }
  }
  return tags;
}

/// A line of the file that may be a track.
struct Line {
  std::string place;  ///< For messages: "lines 12".
  std::vector<Eigen::Vector2d> points_deg;
  std::vector<double> heights_m;  ///< As many, or none.
  MapTags tags;
  bool is_area = false;
  bool is_point = false;
};

/// Takes the lines of a geometry; multi-part ones give several.
void AddLines(const OGRGeometry& geometry, const Line& line, std::vector<Line>& lines) {
  switch (wkbFlatten(geometry.getGeometryType())) {
    case wkbLineString: {
      Line added = line;
      for (const OGRPoint& point : *geometry.toLineString()) {
        added.points_deg.emplace_back(point.getX(), point.getY());
        if (geometry.Is3D()) added.heights_m.push_back(point.getZ());
      }
      lines.push_back(std::move(added));
      break;
    }
    case wkbPoint: {
      Line added = line;
      added.points_deg.emplace_back(geometry.toPoint()->getX(), geometry.toPoint()->getY());
      added.is_point = true;
      lines.push_back(std::move(added));
      break;
    }
    case wkbPolygon: {
      Line added = line;
      added.is_area = true;
      if (const OGRLinearRing* outline = geometry.toPolygon()->getExteriorRing()) {
        for (const OGRPoint& point : *outline) {
          added.points_deg.emplace_back(point.getX(), point.getY());
        }
      }
      lines.push_back(std::move(added));
      break;
    }
    case wkbMultiPolygon:
    case wkbMultiLineString:
    case wkbGeometryCollection:
      for (const OGRGeometry* part : *geometry.toGeometryCollection()) {
        AddLines(*part, line, lines);
      }
      break;
    default:
      break;
  }
}

bool IsOpenStreetMap(GDALDataset& dataset) {
  return EQUAL(dataset.GetDriver()->GetDescription(), "OSM");
}

std::vector<Line> LinesIn(GDALDataset& dataset) {
  std::vector<Line> lines;
  // Its relations have the lines of their ways once more.
  const bool has_relations = IsOpenStreetMap(dataset);
  OGRLayer* layer = nullptr;
  // Features come in the order of the file, whatever their layer, which .pbf files need.
  while (const auto feature = std::unique_ptr<OGRFeature>(
             dataset.GetNextFeature(&layer, nullptr, nullptr, nullptr))) {
    if (has_relations && (EQUAL(layer->GetName(), "multilinestrings") ||
                          EQUAL(layer->GetName(), "other_relations"))) {
      continue;
    }
    const OGRGeometry* geometry = feature->GetGeometryRef();
    if (geometry == nullptr) continue;
    const std::string place =
        std::string(layer->GetName()) + " " + std::to_string(feature->GetFID());
    AddLines(*geometry, {place, {}, {}, FeatureTags(*feature), false, false}, lines);
  }
  return lines;
}

/// What of a file may be a part of a map.
struct VectorFile {
  std::vector<Line> lines;
  bool is_osm{};
};

/// GDAL reads OpenStreetMap's files by tables in memory and in SQLite, and calls their files
/// unreadable when memory has run out.
void EndIfOutOfMemory(std::string_view reason) {
  for (const std::string_view sign : {"llocate", "out of memory", "sqlite3_prepare"}) {
    if (reason.find(sign) != std::string_view::npos) throw std::bad_alloc();
  }
}

/// @param is_in_order Whether OpenStreetMap's nodes are expected in the order of their ids, as most
///   files have them, and GDAL reads them faster then.
/// @return Absent if they are not.
std::optional<VectorFile> ReadFeatures(const std::filesystem::path& file, bool is_in_order) {
  constexpr std::array<const char*, 6> kDrivers = {"OSM",    "GeoJSON", "GPX",
                                                   "LIBKML", "KML",     nullptr};
  constexpr std::array<const char*, 2> kAnyOrder = {"USE_CUSTOM_INDEXING=NO", nullptr};
  GdalErrors gdal_errors;
  const CPLConfigOptionSetter says_what_it_passes_over("CPL_DEBUG", "PBF", false);
  const std::unique_ptr<GDALDataset> dataset(
      GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, kDrivers.data(),
                        is_in_order ? nullptr : kAnyOrder.data()));
  const std::string reason = gdal_errors.first();
  EndIfOutOfMemory(reason);
  if (!dataset) {
    throw InputError(ShownPath(file) +
                     ": must be a map: Overpass JSON, .osm, .pbf, GeoJSON, GPX, KML or railML 3" +
                     (reason.empty() ? "" : " (" + ShownText(reason) + ")"));
  }
  gdal_errors.Forget();
  VectorFile content{LinesIn(*dataset), IsOpenStreetMap(*dataset)};
  // It names its option where it needs the other way.
  if (is_in_order && gdal_errors.first().find("OSM_USE_CUSTOM_INDEXING") != std::string::npos) {
    return std::nullopt;
  }
  EndIfOutOfMemory(gdal_errors.first());
  if (!gdal_errors.first().empty()) {
    throw InputError(ShownPath(file) + ": must be readable to its end (" +
                     ShownText(gdal_errors.first()) + ")");
  }
  return content;
}

/// Whether a line has what GDAL and Overpass Turbo write for those of OpenStreetMap.
bool IsOfOpenStreetMap(const Line& line) {
  return line.tags.contains("osm_id") || line.tags.contains("@id");
}

/// Makes one node of points with equal coordinates.
class NodeIndex {
 public:
  explicit NodeIndex(RailMap& map) : map_(map) {}

  std::size_t Of(const Eigen::Vector2d& point_deg) {
    const auto [entry, is_new] =
        nodes_.try_emplace({point_deg.x(), point_deg.y()}, map_.nodes.size());
    if (is_new) map_.nodes.push_back({.geographic_deg = point_deg, .tags = {}});
    return entry->second;
  }

 private:
  RailMap& map_;
  std::map<std::pair<double, double>, std::size_t> nodes_;
};

bool IsDegrees(const Eigen::Vector2d& point_deg) {
  return std::abs(point_deg.x()) <= kMostLongitude_deg &&
         std::abs(point_deg.y()) <= kMostLatitude_deg;
}

/// Moves platforms, signals and the like from the lines to the map. Other points are dropped, and
/// so are OpenStreetMap's other areas.
void TakeThings(bool is_osm, std::vector<Line>& lines, RailMap& map) {
  std::erase_if(lines, [&](Line& line) {
    const bool is_place =
        !line.points_deg.empty() && std::ranges::all_of(line.points_deg, IsDegrees);
    if (!IsThing(line.tags) || !is_place) {
      return line.is_point || (is_osm && line.is_area);
    }
    map.things.push_back({std::move(line.points_deg), {}, std::move(line.tags)});
    return true;
  });
}

/// Appends a line as a way.
void AddWay(const Line& line, NodeIndex& nodes, RailMap& map, ErrorList& errors) {
  if (line.is_area) {
    errors.Add({line.place, "must be a line, since it is to be a track", "a polygon"});
    return;
  }
  MapWay way{static_cast<std::int64_t>(map.ways.size()), {}, line.tags};
  for (std::size_t i = 0; i < line.points_deg.size(); ++i) {
    const Eigen::Vector2d& point_deg = line.points_deg[i];
    if (!IsDegrees(point_deg)) {
      errors.Add({line.place, "must have longitudes and latitudes in degrees",
                  NumberText(point_deg.x()) + ", " + NumberText(point_deg.y())});
      return;
    }
    const std::size_t node = nodes.Of(point_deg);
    AppendNode(node, way);
    if (line.heights_m.empty() || map.nodes[node].height_m) continue;
    if (!IsHeight(line.heights_m[i])) {
      errors.Add({line.place, kHeightRule, NumberText(line.heights_m[i])});
      return;
    }
    map.nodes[node].height_m = line.heights_m[i];
  }
  if (way.nodes.size() < 2) {
    errors.Add(
        {line.place, "must have two different points or more", std::to_string(way.nodes.size())});
    return;
  }
  map.ways.push_back(std::move(way));
}

}  // namespace

RailMap ReadVectorMap(const std::filesystem::path& file) {
  CheckIsReadable(file);
  GDALAllRegister();
  std::optional<VectorFile> content = ReadFeatures(file, true);
  if (!content) content = ReadFeatures(file, false);
  std::vector<Line>& lines = content->lines;
  RailMap map;
  if (content->is_osm || std::ranges::any_of(lines, IsOfOpenStreetMap)) {
    map.attribution = kOpenStreetMapAttribution;
  }
  TakeThings(content->is_osm, lines, map);
  const std::size_t num_lines = lines.size();
  const bool has_railways = std::ranges::any_of(
      lines, [](const Line& line) { return !TagOf(line.tags, "railway").empty(); });
  if (has_railways || content->is_osm) {
    std::erase_if(lines, [](const Line& line) { return !IsTrack(TagOf(line.tags, "railway")); });
  }
  NodeIndex nodes(map);
  ErrorList errors;
  for (const Line& line : lines) AddWay(line, nodes, map, errors);
  AtPlace(ShownPath(file) + ": ", [&] { errors.ThrowIfAny(); });
  if (map.ways.empty()) {
    throw InputError(ShownPath(file) + ": must have a line that is a track (got " +
                     std::to_string(num_lines) + " other lines)");
  }
  return map;
}

}  // namespace railcast
