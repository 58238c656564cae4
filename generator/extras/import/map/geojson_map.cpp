#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "generator/extras/import/map/map_formats.h"
#include "generator/extras/import/map/map_lines.h"

namespace railcast {
namespace {

/// What a value is, as messages show it.
std::string GotOf(const Json& value) {
  return value.is_primitive() ? ShownText(value.dump()) : value.type_name();
}

/// "name"=>"value" pairs, as GDAL writes the tags for which it has no column.
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

/// Properties as tags. osmtogeojson has those of OpenStreetMap in one more object.
void AddTagsIn(const Json& properties, MapTags& tags) {
  if (!properties.is_object()) return;
  for (const auto& [key, value] : properties.items()) {
    if (key == "tags") {
      const Json inner =
          value.is_string() ? ParseJson(value.get<std::string>()).json.value_or(nullptr) : value;
      AddTagsIn(inner, tags);
    } else if (key == "other_tags" && value.is_string()) {
      AddOtherTags(value.get<std::string>(), tags);
    } else if (value.is_string() && !value.get<std::string>().empty()) {
      tags.emplace(key == "Name" ? "name" : key, value.get<std::string>());
    } else if (value.is_number() || value.is_boolean()) {
      tags.emplace(key, value.is_number_float() ? NumberText(value.get<double>()) : value.dump());
    }
  }
}

class GeoJsonReader {
 public:
  void ReadObject(const Json& object, const std::string& pointer, const MapTags& tags, int depth) {
    constexpr int kDeepest = 8;
    if (!object.is_object()) return;
    if (depth > kDeepest) {
      errors_.Add({pointer, "must not be nested deeper than 8 levels", "more"});
      return;
    }
    CheckSystem(object, pointer);
    MapTags own = tags;
    const std::size_t num_before = lines_.size();
    if (object.contains("properties")) AddTagsIn(object["properties"], own);
    for (const char* key : {"features", "geometries"}) {
      if (!object.contains(key) || !object[key].is_array()) continue;
      for (std::size_t i = 0; i < object[key].size(); ++i) {
        ReadObject(object[key][i], pointer + "/" + key + "/" + std::to_string(i), own, depth + 1);
      }
    }
    if (object.contains("geometry")) {
      ReadObject(object["geometry"], pointer + "/geometry", own, depth + 1);
    }
    if (object.contains("coordinates")) ReadCoordinates(object, pointer, own);
    const bool is_drawn =
        std::any_of(lines_.begin() + static_cast<std::ptrdiff_t>(num_before), lines_.end(),
                    [](const MapLine& line) { return !line.is_point; });
    const std::string_view railway = TagOf(own, "railway");
    const bool is_empty = object.contains("geometry") && object["geometry"].is_null();
    const bool may_be_track = IsTrack(railway) || (railway.empty() && is_empty);
    if (!object.contains("properties") || is_drawn || !may_be_track) return;
    remarks_.push_back({RemarkKind::kLinesLeftOut, pointer, 1, "it has no line"});
  }

  [[nodiscard]] ErrorList& errors() { return errors_; }
  [[nodiscard]] std::vector<MapLine>& lines() { return lines_; }
  [[nodiscard]] std::vector<Remark>& remarks() { return remarks_; }

 private:
  /// Older files, and JSON-FG, may name another system than the only one of GeoJSON today. Those of
  /// EPSG have latitude first by the letter of their register, but not in most files.
  void CheckSystem(const Json& object, const std::string& pointer) {
    for (const char* const key : {"crs", "coordRefSys"}) {
      if (!object.contains(key) || object[key].is_null()) continue;
      const std::string text = object[key].dump();
      const auto has = [&](std::string_view name) { return text.find(name) != std::string::npos; };
      if (has("CRS84")) continue;
      if (has("4326") || has("4979") || has("4258")) {
        remarks_.push_back(
            {RemarkKind::kTagsUnread, pointer + "/" + key, 1,
             "the order of axes; longitude is taken to be first (got " + ShownText(text) + ")"});
        continue;
      }
      errors_.Add(
          {pointer + "/" + key,
           "must be WGS 84, as GeoJSON has it (ogr2ogr -t_srs EPSG:4326 OUT.geojson IN.geojson "
           "converts it)",
           ShownText(text)});
    }
  }

  void ReadCoordinates(const Json& object, const std::string& pointer, const MapTags& tags) {
    struct Kind {
      const char* type;
      int depth;  ///< Depth of the lists of positions.
      bool is_area;
    };
    constexpr std::array<Kind, 6> kKinds = {{{"Point", 0, false},
                                             {"MultiPoint", 1, false},
                                             {"LineString", 1, false},
                                             {"MultiLineString", 2, false},
                                             {"Polygon", 2, true},
                                             {"MultiPolygon", 3, true}}};
    const Json& coordinates = object["coordinates"];
    const std::string place = pointer + "/coordinates";
    const auto kind = std::ranges::find_if(kKinds, [&](const Kind& one) {
      return object.contains("type") && object["type"] == one.type;
    });
    if (kind == kKinds.end()) {
      errors_.Add({pointer + "/type", "must be a geometry of GeoJSON",
                   object.contains("type") ? GotOf(object["type"]) : "none"});
      return;
    }
    MapLine line{.place = pointer, .points_deg = {}, .heights_m = {}, .tags = tags};
    line.is_area = kind->is_area;
    line.is_point = kind->depth == 0 || kind == kKinds.begin() + 1;
    if (kind->depth > 0) return ReadLists(coordinates, kind->depth, line, place);
    AddPosition(coordinates, place, line);
    lines_.push_back(std::move(line));
  }

  /// Reads lists of positions that are nested so deep as lines.
  void ReadLists(const Json& list, int depth, const MapLine& like, const std::string& pointer) {
    if (!CheckList(list, pointer)) return;
    MapLine line = like;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::string place = pointer + "/" + std::to_string(i);
      if (depth > 1) {
        ReadLists(list[i], depth - 1, like, place);
        // All rings of an area but the first are holes.
        if (like.is_area && depth == 2) break;
      } else {
        AddPosition(list[i], place, line);
      }
    }
    if (depth == 1) lines_.push_back(std::move(line));
  }

  void AddPosition(const Json& position, const std::string& pointer, MapLine& line) {
    if (!CheckList(position, pointer)) return;
    if (position.size() < 2) {
      errors_.Add({pointer, "must have a longitude and a latitude",
                   std::to_string(position.size()) + " numbers"});
      return;
    }
    for (std::size_t i = 0; i < position.size(); ++i) {
      if (position[i].is_number()) continue;
      errors_.Add({pointer + "/" + std::to_string(i), "must be a number", GotOf(position[i])});
      return;
    }
    line.points_deg.emplace_back(position[0].get<double>(), position[1].get<double>());
    line.heights_m.push_back(position.size() > 2 ? std::optional(position[2].get<double>())
                                                 : std::nullopt);
  }

  [[nodiscard]] bool CheckList(const Json& list, const std::string& pointer) {
    if (list.is_array()) return true;
    errors_.Add({pointer, "must be a list of coordinates", GotOf(list)});
    return false;
  }

  ErrorList errors_;
  std::vector<MapLine> lines_;
  std::vector<Remark> remarks_;
};

/// Throws if a server says that there is more than it gave, as ArcGIS, WFS and OGC's APIs do.
void CheckIsAll(const Json& root) {
  const auto fail = [](const std::string& got) {
    throw InputError(
        "must hold all features that there are, and not the first ones alone, or else not say so "
        "(got " +
        got + ")");
  };
  const Json properties = root.value("properties", Json());
  for (const Json* object : {&root, &properties}) {
    if (object->is_object() && object->value("exceededTransferLimit", Json()) == true) {
      fail("exceededTransferLimit");
    }
  }
  const std::size_t num = root.contains("features") ? root["features"].size() : 0;
  for (const char* key : {"numberMatched", "totalFeatures"}) {
    const Json stated = root.value(key, Json());
    if (stated.is_number() && stated > num) {
      fail(NumberText(num) + " of " + key + " " + stated.dump());
    }
  }
  if (root.value("numberMatched", Json()) == num) return;
  for (const Json& link : root.value("links", Json::array())) {
    if (link.is_object() && link.value("rel", Json()) == "next") fail("a link to the next ones");
  }
}

/// Whether a line has what GDAL, Overpass Turbo and osmtogeojson write for those of OpenStreetMap.
bool IsOfOpenStreetMap(const MapLine& line) {
  return line.tags.contains("osm_id") || line.tags.contains("@id") ||
         (line.tags.contains("id") && TagOf(line.tags, "type") == "way");
}

}  // namespace

RailMap ReadGeoJson(const std::filesystem::path& file) {
  const Json root = ReadMapJson(file);
  return AtPlace(ShownPath(file) + ": ", [&] {
    const auto fail = [](const std::string& got) {
      throw InputError("must be GeoJSON (ogr2ogr OUT.geojson IN.json makes it) (got " + got + ")");
    };
    const bool is_esri = root.is_object() && !root.contains("type") &&
                         (root.contains("geometryType") || root.contains("spatialReference"));
    if (is_esri) fail("Esri JSON");
    if (!root.is_object() || !root.contains("type")) {
      throw InputError(
          "must be a map: Overpass JSON has a list \"elements\", GeoJSON a \"type\" (got neither)");
    }
    if (root["type"] == "Topology") fail("TopoJSON");
    CheckIsAll(root);
    GeoJsonReader reader;
    reader.ReadObject(root, "", {}, 0);
    reader.errors().ThrowIfAny();
    const bool is_osm = std::ranges::any_of(reader.lines(), IsOfOpenStreetMap);
    RailMap map = MapOfLines(std::move(reader.lines()), std::move(reader.remarks()));
    if (is_osm) map.attribution = kOpenStreetMapAttribution;
    return map;
  });
}

}  // namespace railcast
