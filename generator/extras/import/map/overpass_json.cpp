#include <cmath>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "generator/extras/import/map/map_formats.h"
#include "generator/extras/import/map/osm_map.h"

namespace railcast {
namespace {

MapTags OverpassTags(const Json& element) {
  MapTags tags;
  if (!element.contains("tags") || !element["tags"].is_object()) return tags;
  for (const auto& [key, value] : element["tags"].items()) {
    if (value.is_string()) tags.emplace(key, value.get<std::string>());
    if (value.is_number()) tags.emplace(key, value.dump());
  }
  return tags;
}
/// Takes the elements of an answer one by one.
class OverpassReader {
 public:
  void Read(const Json& elements) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
      ReadElement(elements[i], "/elements/" + std::to_string(i));
    }
  }

  [[nodiscard]] ErrorList& errors() { return errors_; }
  [[nodiscard]] OsmMapMaker& maker() { return maker_; }

 private:
  void ReadElement(const Json& element, const std::string& pointer) {
    if (!element.is_object() || !element.contains("type") || !element["type"].is_string()) {
      errors_.Add({pointer + "/type", "must be node, way or relation", element.type_name()});
      return;
    }
    const auto type = element["type"].get<std::string>();
    if (type == "area" || type == "count" || type == "timeline") return;
    if (type != "node" && type != "way" && type != "relation") {
      errors_.Add({pointer + "/type", "must be node, way or relation", Quoted(type)});
      return;
    }
    if (element.contains("tags") && !element["tags"].is_object()) {
      errors_.Add({pointer + "/tags", "must be an object", element["tags"].type_name()});
      return;
    }
    const auto id = IdOf(element, pointer);
    if (!id) return;
    const auto word = [&](const char* key) {
      const bool is_there = element.contains(key);
      return !is_there                  ? std::string()
             : element[key].is_string() ? element[key].get<std::string>()
                                        : element[key].dump();
    };
    const std::string action = word("action");
    const std::string visible = word("visible");
    bool is_deleted = false;
    AddFault(CheckLife(action.empty() ? nullptr : action.c_str(),
                       visible.empty() ? nullptr : visible.c_str(), is_deleted),
             pointer);
    if (is_deleted) {
      AddFault(maker_.AddDeleted(type, *id, OverpassTags(element)), pointer);
    } else if (type == "node") {
      ReadNode(element, *id, pointer);
    } else if (type == "way") {
      ReadWay(element, *id, pointer);
    } else {
      maker_.AddRelation(*id, OverpassTags(element));
    }
  }

  void ReadNode(const Json& element, std::int64_t id, const std::string& pointer) {
    const auto place_deg = PlaceOf_deg(element, pointer);
    if (place_deg) AddFault(maker_.AddNode(id, *place_deg, OverpassTags(element)), pointer);
  }

  void ReadWay(const Json& element, std::int64_t id, const std::string& pointer) {
    OsmWay way{id, {}, {}, OverpassTags(element)};
    // Others may be there without their nodes.
    const bool is_kept = IsTrack(TagOf(way.tags, "railway")) || IsThing(way.tags);
    if (is_kept && !ReadNodes(element, pointer, way)) return;
    AddFault(maker_.AddWay(std::move(way)), pointer);
  }

  /// A number of 64 bits with sign; otherwise a fault with this rule.
  [[nodiscard]] std::optional<std::int64_t> OverpassId(const Json& value,
                                                       const std::string& place,
                                                       const std::string& rule) {
    const bool fits = value.is_number_unsigned()
                          ? std::in_range<std::int64_t>(value.get<std::uint64_t>())
                          : value.is_number_integer();
    if (fits) return value.get<std::int64_t>();
    if (value.is_number()) {
      errors_.Add({place, rule + " of 64 bits", value.dump()});
    } else {
      errors_.Add({place, rule, value.type_name()});
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<std::int64_t> IdOf(const Json& element, const std::string& pointer) {
    if (!element.contains("id")) {
      errors_.Add({pointer + "/id", "must be a whole number", "none"});
      return std::nullopt;
    }
    return OverpassId(element["id"], pointer + "/id", "must be a whole number");
  }

  [[nodiscard]] std::optional<double> DegreesOf(const Json& element,
                                                const std::string& pointer,
                                                const char* key,
                                                double most_deg) {
    const std::string rule = DegreesRule(most_deg);
    if (!element.contains(key) || !element[key].is_number()) {
      errors_.Add(
          {pointer + "/" + key, rule, element.contains(key) ? element[key].type_name() : "none"});
      return std::nullopt;
    }
    const auto value_deg = element[key].get<double>();
    if (std::abs(value_deg) <= most_deg) return value_deg;
    errors_.Add({pointer + "/" + key, rule, NumberText(value_deg)});
    return std::nullopt;
  }

  [[nodiscard]] std::optional<Eigen::Vector2d> PlaceOf_deg(const Json& element,
                                                           const std::string& pointer) {
    const auto longitude_deg = DegreesOf(element, pointer, "lon", kMostLongitude_deg);
    const auto latitude_deg = DegreesOf(element, pointer, "lat", kMostLatitude_deg);
    if (!longitude_deg || !latitude_deg) return std::nullopt;
    return Eigen::Vector2d(*longitude_deg, *latitude_deg);
  }

  /// Whether the nodes of a way could be read.
  [[nodiscard]] bool ReadNodes(const Json& element, const std::string& pointer, OsmWay& way) {
    const auto is_list = [&](const char* key) {
      return element.contains(key) && element[key].is_array();
    };
    const bool is_drawn = is_list("geometry");
    if (!is_list("nodes") && (!is_drawn || element.contains("nodes"))) {
      errors_.Add({pointer + "/nodes", "must be a list of node ids",
                   element.contains("nodes") ? element["nodes"].type_name() : "none"});
      return false;
    }
    const std::size_t num = element[is_drawn ? "geometry" : "nodes"].size();
    if (is_drawn && is_list("nodes") && element["nodes"].size() != num) {
      errors_.Add({pointer + "/geometry", "must have a place for each of the nodes",
                   std::to_string(num) + " for " + std::to_string(element["nodes"].size())});
      return false;
    }
    for (std::size_t i = 0; i < num; ++i) {
      if (is_list("nodes")) {
        const auto id = OverpassId(element["nodes"][i], pointer + "/nodes/" + std::to_string(i),
                                   "must be a node id");
        if (!id) return false;
        way.nodes.push_back(*id);
      }
      if (!is_drawn) continue;
      // `out geom(BOX);` gives null for places outside of the box.
      const Json& point = element["geometry"][i];
      const std::string place = pointer + "/geometry/" + std::to_string(i);
      if (!point.is_object() && !point.is_null()) {
        errors_.Add({place, "must be a place", point.type_name()});
        return false;
      }
      way.drawn_deg.push_back(point.is_null() ? std::nullopt : PlaceOf_deg(point, place));
      if (!point.is_null() && !way.drawn_deg.back()) return false;
    }
    return true;
  }

  void AddFault(std::optional<Fault> fault, const std::string& pointer) {
    if (!fault) return;
    fault->place = pointer + (fault->place.empty() ? "" : "/") + fault->place;
    errors_.Add(*std::move(fault));
  }

  ErrorList errors_;
  OsmMapMaker maker_;
};

}  // namespace

RailMap ReadOverpassJson(const std::filesystem::path& file) {
  const Json root = ReadMapJson(file);
  const std::string shown = ShownPath(file) + ": ";
  if (root.is_object() && root.contains("remark")) {
    const Json& remark = root["remark"];
    RefuseRemark(shown + "/remark", remark.is_string() ? remark.get<std::string>() : remark.dump());
  }
  if (!root.is_object() || !root.contains("elements") || !root["elements"].is_array()) {
    throw InputError(
        shown + "/elements: must be a list, as the Overpass API returns it (got " +
        (root.is_object() && root.contains("elements") ? root["elements"].type_name() : "none") +
        ")");
  }
  OverpassReader reader;
  reader.Read(root["elements"]);
  return AtPlace(shown, [&] {
    reader.errors().ThrowIfAny();
    return reader.maker().Make();
  });
}

}  // namespace railcast
