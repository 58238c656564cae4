#include "generator/import/map/map_formats.h"

#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {
namespace {

/// Takes the elements of an answer one by one.
class OverpassReader {
 public:
  explicit OverpassReader(ErrorList& errors) : errors_(errors) {}

  void Read(const Json& elements);
  [[nodiscard]] RailMap TakeMap() { return std::move(map_); }

 private:
  void ReadNode(const Json& element, const std::string& pointer);
  void ReadWay(const Json& element, const std::string& pointer);
  /// A number of 64 bits with sign; otherwise a fault with this rule.
  [[nodiscard]] std::optional<std::int64_t> OverpassId(const Json& value,
                                                       const std::string& place,
                                                       const std::string& rule);
  [[nodiscard]] std::optional<std::int64_t> IdOf(const Json& element, const std::string& pointer);
  [[nodiscard]] std::optional<double> DegreesOf(const Json& element,
                                                const std::string& pointer,
                                                const char* key,
                                                double most_deg);

  [[nodiscard]] std::optional<Eigen::Vector2d> PlaceOf_deg(const Json& element,
                                                           const std::string& pointer);
  /// The node of an id, which has one place wherever it is named.
  [[nodiscard]] std::optional<std::size_t> NodeOf(std::int64_t id,
                                                  const Eigen::Vector2d& place_deg,
                                                  const std::string& pointer);
  /// A node that stands in the file as an element of its own.
  [[nodiscard]] std::optional<std::size_t> GivenNode(const Json& id, const std::string& place);
  /// A node of a way with its geometry (`out geom;`).
  [[nodiscard]] std::optional<std::size_t> DrawnNode(const Json& element,
                                                     std::size_t i,
                                                     const std::string& pointer);
  [[nodiscard]] std::optional<std::vector<std::size_t>> NodesOf(const Json& element,
                                                                const std::string& pointer);

  ErrorList& errors_;
  RailMap map_;
  std::unordered_map<std::int64_t, std::size_t> nodes_;  ///< By id.
  /// Of ways with their geometry but without ids, which meet where they share a place.
  std::map<std::pair<double, double>, std::size_t> places_;
  std::unordered_set<std::int64_t> ways_;  ///< Ids.
};

MapTags OverpassTags(const Json& element) {
  MapTags tags;
  if (!element.contains("tags") || !element["tags"].is_object()) return tags;
  for (const auto& [key, value] : element["tags"].items()) {
    if (value.is_string()) tags.emplace(key, value.get<std::string>());
  }
  return tags;
}

/// The value of the key `ele`; absent if it is anything else than a height in metres.
std::optional<double> HeightOf_m(std::string_view value) {
  const std::optional<double> height_m = NumberIn(value);
  return height_m && IsHeight(*height_m) ? height_m : std::nullopt;
}

std::optional<std::int64_t> OverpassReader::OverpassId(const Json& value,
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

std::optional<std::int64_t> OverpassReader::IdOf(const Json& element, const std::string& pointer) {
  if (!element.contains("id")) {
    errors_.Add({pointer + "/id", "must be a whole number", "none"});
    return std::nullopt;
  }
  return OverpassId(element["id"], pointer + "/id", "must be a whole number");
}

std::optional<double> OverpassReader::DegreesOf(const Json& element,
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

std::optional<Eigen::Vector2d> OverpassReader::PlaceOf_deg(const Json& element,
                                                           const std::string& pointer) {
  const auto longitude_deg = DegreesOf(element, pointer, "lon", kMostLongitude_deg);
  const auto latitude_deg = DegreesOf(element, pointer, "lat", kMostLatitude_deg);
  if (!longitude_deg || !latitude_deg) return std::nullopt;
  return Eigen::Vector2d(*longitude_deg, *latitude_deg);
}

std::optional<std::size_t> OverpassReader::NodeOf(std::int64_t id,
                                                  const Eigen::Vector2d& place_deg,
                                                  const std::string& pointer) {
  const auto [entry, is_new] = nodes_.try_emplace(id, map_.nodes.size());
  if (is_new) map_.nodes.push_back({.geographic_deg = place_deg, .tags = {}});
  const Eigen::Vector2d& known_deg = map_.nodes[entry->second].geographic_deg;
  if (known_deg == place_deg) return entry->second;
  const auto shown = [](const Eigen::Vector2d& at_deg) {
    return NumberText(at_deg.x()) + ", " + NumberText(at_deg.y());
  };
  errors_.Add({pointer,
               "must be where node " + std::to_string(id) + " is before, at " + shown(known_deg),
               shown(place_deg)});
  return std::nullopt;
}

void OverpassReader::ReadNode(const Json& element, const std::string& pointer) {
  const auto id = IdOf(element, pointer);
  const auto place_deg = PlaceOf_deg(element, pointer);
  if (!id || !place_deg) return;
  // An answer may repeat nodes, with their tags or without.
  const auto index = NodeOf(*id, *place_deg, pointer);
  MapTags tags = OverpassTags(element);
  if (!index || tags.empty() || !map_.nodes[*index].tags.empty()) return;
  MapNode& node = map_.nodes[*index];
  node.tags = std::move(tags);
  node.height_m = HeightOf_m(TagOf(node.tags, "ele"));
  if (IsThing(node.tags)) map_.things.push_back({{node.geographic_deg}, {}, node.tags});
}

std::optional<std::size_t> OverpassReader::GivenNode(const Json& id, const std::string& place) {
  const auto node_id = OverpassId(id, place, "must be a node id");
  if (!node_id) return std::nullopt;
  const auto found = nodes_.find(*node_id);
  if (found != nodes_.end()) return found->second;
  errors_.Add(
      {place, "must be a node of this file (ask Overpass for the nodes, too: >; out;)", id.dump()});
  return std::nullopt;
}

std::optional<std::size_t> OverpassReader::DrawnNode(const Json& element,
                                                     std::size_t i,
                                                     const std::string& pointer) {
  const Json& point = element["geometry"][i];
  const std::string place = pointer + "/geometry/" + std::to_string(i);
  if (!point.is_object()) {
    errors_.Add({place, "must be a place (ask Overpass for whole ways: out geom; without a box)",
                 point.type_name()});
    return std::nullopt;
  }
  const auto place_deg = PlaceOf_deg(point, place);
  if (!place_deg) return std::nullopt;
  if (!element.contains("nodes")) {
    const auto [entry, is_new] =
        places_.try_emplace({place_deg->x(), place_deg->y()}, map_.nodes.size());
    if (is_new) map_.nodes.push_back({.geographic_deg = *place_deg, .tags = {}});
    return entry->second;
  }
  const auto id =
      OverpassId(element["nodes"][i], pointer + "/nodes/" + std::to_string(i), "must be a node id");
  return id ? NodeOf(*id, *place_deg, place) : std::nullopt;
}

std::optional<std::vector<std::size_t>> OverpassReader::NodesOf(const Json& element,
                                                                const std::string& pointer) {
  const auto is_list = [&](const char* key) {
    return element.contains(key) && element[key].is_array();
  };
  const bool is_drawn = is_list("geometry");
  if (!is_list("nodes") && (!is_drawn || element.contains("nodes"))) {
    errors_.Add({pointer + "/nodes", "must be a list of node ids",
                 element.contains("nodes") ? element["nodes"].type_name() : "none"});
    return std::nullopt;
  }
  const std::size_t num = element[is_drawn ? "geometry" : "nodes"].size();
  if (is_drawn && is_list("nodes") && element["nodes"].size() != num) {
    errors_.Add({pointer + "/geometry", "must have a place for each of the nodes",
                 std::to_string(num) + " for " + std::to_string(element["nodes"].size())});
    return std::nullopt;
  }
  std::vector<std::size_t> nodes;
  for (std::size_t i = 0; i < num; ++i) {
    const auto node = is_drawn
                          ? DrawnNode(element, i, pointer)
                          : GivenNode(element["nodes"][i], pointer + "/nodes/" + std::to_string(i));
    if (!node) return std::nullopt;
    nodes.push_back(*node);
  }
  return nodes;
}

void OverpassReader::ReadWay(const Json& element, const std::string& pointer) {
  const auto id = IdOf(element, pointer);
  if (!id) return;
  MapTags tags = OverpassTags(element);
  const bool is_track = IsTrack(TagOf(tags, "railway"));
  if (!is_track && !IsThing(tags)) return;
  if (!ways_.insert(*id).second) return;  // An answer may repeat ways, too.
  const auto nodes = NodesOf(element, pointer);
  if (!nodes) return;
  MapWay way{*id, {}, std::move(tags)};
  for (const std::size_t node : *nodes) AppendNode(node, way);
  if (way.nodes.size() < 2) {
    errors_.Add({pointer + (element.contains("nodes") ? "/nodes" : "/geometry"),
                 "must have two different nodes or more", std::to_string(way.nodes.size())});
    return;
  }
  if (is_track) {
    map_.ways.push_back(std::move(way));
    return;
  }
  MapThing thing{{}, {}, std::move(way.tags)};
  for (const std::size_t node : way.nodes) {
    thing.geographic_deg.push_back(map_.nodes[node].geographic_deg);
  }
  map_.things.push_back(std::move(thing));
}

void OverpassReader::Read(const Json& elements) {
  // Nodes may follow the ways that need them.
  for (const bool reads_nodes : {true, false}) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const Json& element = elements[i];
      const std::string pointer = "/elements/" + std::to_string(i);
      if (!element.is_object() || !element.contains("type") || !element["type"].is_string()) {
        errors_.Add({pointer + "/type", "must be node, way or relation", element.type_name()});
        continue;
      }
      const auto type = element["type"].get<std::string>();
      if (reads_nodes && type == "node") ReadNode(element, pointer);
      if (!reads_nodes && type == "way") ReadWay(element, pointer);
    }
  }
}

}  // namespace

RailMap ReadOverpassJson(const std::filesystem::path& file) {
  const Json root = ReadMapJson(file);
  ErrorList errors;
  if (!root.is_object() || !root.contains("elements") || !root["elements"].is_array()) {
    throw InputError(
        ShownPath(file) + ": /elements: must be a list, as the Overpass API returns it (got " +
        (root.is_object() && root.contains("elements") ? root["elements"].type_name() : "none") +
        ")");
  }
  OverpassReader reader(errors);
  reader.Read(root["elements"]);
  AtPlace(ShownPath(file) + ": ", [&] { errors.ThrowIfAny(); });
  RailMap map = reader.TakeMap();
  if (map.ways.empty()) {
    throw InputError(ShownPath(file) +
                     ": /elements: must have a way with railway=rail or another kind of track "
                     "(got " +
                     std::to_string(root["elements"].size()) + " elements)");
  }
  map.attribution = kOpenStreetMapAttribution;
  return map;
}

}  // namespace railcast
