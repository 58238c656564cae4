#include "generator/import/map/overpass_json.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "core/base/attempt.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/strict_json.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

constexpr std::string_view kAttribution =
    "(c) OpenStreetMap contributors, ODbL 1.0 (https://www.openstreetmap.org/copyright)";

/// Takes the elements of an answer one by one.
class OverpassReader {
 public:
  explicit OverpassReader(ErrorList& errors) : errors_(errors) {}

  void Read(const StrictJson& elements);
  [[nodiscard]] RailMap TakeMap() { return std::move(map_); }

 private:
  void ReadNode(const StrictJson& element, const std::string& pointer);
  void ReadWay(const StrictJson& element, const std::string& pointer);
  /// A number of 64 bits with sign; otherwise a fault with this rule.
  [[nodiscard]] std::optional<std::int64_t> OverpassId(const StrictJson& value,
                                                       const std::string& place,
                                                       const std::string& rule);
  [[nodiscard]] std::optional<std::int64_t> IdOf(const StrictJson& element,
                                                 const std::string& pointer);
  [[nodiscard]] std::optional<double> DegreesOf(const StrictJson& element,
                                                const std::string& pointer,
                                                const char* key,
                                                double most_deg);

  ErrorList& errors_;
  RailMap map_;
  std::unordered_map<std::int64_t, std::size_t> nodes_;  ///< By id.
  std::unordered_set<std::int64_t> ways_;                ///< Ids.
};

MapTags OverpassTags(const StrictJson& element) {
  MapTags tags;
  if (!element.contains("tags") || !element["tags"].is_object()) return tags;
  for (const auto& [key, value] : element["tags"].items()) {
    if (value.is_string()) tags.emplace(key, value.get<std::string>());
  }
  return tags;
}

/// The value of the key `ele`; absent if it is anything else than a height in metres.
std::optional<double> HeightOf_m(std::string_view value) {
  double height_m = 0.0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), height_m);
  if (error != std::errc{} || end != value.data() + value.size()) return std::nullopt;
  return IsHeight(height_m) ? std::optional(height_m) : std::nullopt;
}

std::optional<std::int64_t> OverpassReader::OverpassId(const StrictJson& value,
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

std::optional<std::int64_t> OverpassReader::IdOf(const StrictJson& element,
                                                 const std::string& pointer) {
  if (!element.contains("id")) {
    errors_.Add({pointer + "/id", "must be a whole number", "none"});
    return std::nullopt;
  }
  return OverpassId(element["id"], pointer + "/id", "must be a whole number");
}

std::optional<double> OverpassReader::DegreesOf(const StrictJson& element,
                                                const std::string& pointer,
                                                const char* key,
                                                double most_deg) {
  const std::string rule =
      "must be a number of degrees from " + NumberText(-most_deg) + " to " + NumberText(most_deg);
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

void OverpassReader::ReadNode(const StrictJson& element, const std::string& pointer) {
  const auto id = IdOf(element, pointer);
  const auto longitude_deg = DegreesOf(element, pointer, "lon", 180.0);
  const auto latitude_deg = DegreesOf(element, pointer, "lat", 90.0);
  if (!id || !longitude_deg || !latitude_deg) return;
  if (!nodes_.emplace(*id, map_.nodes.size()).second) return;  // An answer may repeat nodes.
  MapNode node{.geographic_deg = {*longitude_deg, *latitude_deg}, .tags = OverpassTags(element)};
  node.height_m = HeightOf_m(TagOf(node.tags, "ele"));
  if (IsThing(node.tags)) {
    map_.things.push_back({{node.geographic_deg}, {}, node.tags});
  }
  map_.nodes.push_back(std::move(node));
}

void OverpassReader::ReadWay(const StrictJson& element, const std::string& pointer) {
  const auto id = IdOf(element, pointer);
  if (!id) return;
  MapTags tags = OverpassTags(element);
  const bool is_track = IsTrack(TagOf(tags, "railway"));
  if (!is_track && !IsThing(tags)) return;
  if (!ways_.insert(*id).second) return;  // An answer may repeat ways, too.
  if (!element.contains("nodes") || !element["nodes"].is_array()) {
    errors_.Add({pointer + "/nodes", "must be a list of node ids",
                 element.contains("nodes") ? element["nodes"].type_name() : "none"});
    return;
  }
  MapWay way{*id, {}, std::move(tags)};
  const StrictJson& nodes = element["nodes"];
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::string place = pointer + "/nodes/" + std::to_string(i);
    const auto node_id = OverpassId(nodes[i], place, "must be a node id");
    if (!node_id) return;
    const auto found = nodes_.find(*node_id);
    if (found == nodes_.end()) {
      errors_.Add({place, "must be a node of this file (ask Overpass for the nodes, too: >; out;)",
                   nodes[i].dump()});
      return;
    }
    AppendNode(found->second, way);
  }
  if (way.nodes.size() < 2) {
    errors_.Add({pointer + "/nodes", "must have two different nodes or more",
                 std::to_string(way.nodes.size())});
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

void OverpassReader::Read(const StrictJson& elements) {
  // Nodes may follow the ways that need them.
  for (const bool reads_nodes : {true, false}) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const StrictJson& element = elements[i];
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
  const std::string text = ReadFileWhole(file);
  ErrorList errors;
  StrictJson root;
  try {
    root = StrictJson::parse(text);
  } catch (const StrictJson::exception& error) {
    throw InputError(ShownPath(file) + ": must be JSON: " + ShownLines(error.what()));
  }
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
  map.attribution = kAttribution;
  return map;
}

}  // namespace railcast
