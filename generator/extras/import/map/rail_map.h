#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railcast/remark.h"

namespace railcast {

/// Keys and values of a mapped thing, as OpenStreetMap has them ("maxspeed": "120").
using MapTags = std::map<std::string, std::string, std::less<>>;

/// The value of a key; empty if there is none.
[[nodiscard]] inline std::string_view TagOf(const MapTags& tags, std::string_view key) {
  const auto found = tags.find(key);
  return found == tags.end() ? std::string_view{} : found->second;
}

/// The values of a list as OpenStreetMap has them: "contact_line;rail". None of an empty text.
[[nodiscard]] inline std::vector<std::string_view> ValuesOf(std::string_view list) {
  std::vector<std::string_view> values;
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(';'), list.size());
    std::string_view value = list.substr(0, end);
    list.remove_prefix(std::min(end + 1, list.size()));
    while (value.starts_with(' ')) value.remove_prefix(1);
    while (value.ends_with(' ')) value.remove_suffix(1);
    if (!value.empty()) values.push_back(value);
  }
  return values;
}

/// Whether a list (ValuesOf()) has one of some values.
[[nodiscard]] inline bool HasOneOf(std::string_view list,
                                   std::initializer_list<std::string_view> wanted) {
  return std::ranges::any_of(ValuesOf(list), [&](std::string_view value) {
    return std::ranges::find(wanted, value) != wanted.end();
  });
}

/// Whether OpenStreetMap's key `railway` has a track that trains can run on.
[[nodiscard]] inline bool IsTrack(std::string_view railway) {
  return HasOneOf(railway, {"rail", "light_rail", "narrow_gauge", "subway", "tram", "preserved"});
}

/// The tag of what may be rails, but is no track as of IsTrack(): any `railway`, as "Railway=rail"
/// or "railway=disused", but what stands beside tracks or is not there. Empty if there is none.
[[nodiscard]] std::string UnreadTrackTag(const MapTags& tags);

/// Whether OpenStreetMap's tags are those of a platform beside tracks, and not of one for buses or
/// ships.
[[nodiscard]] bool IsPlatform(const MapTags& tags);

/// Whether OpenStreetMap's tags are those of a thing of which import makes something.
[[nodiscard]] bool IsThing(const MapTags& tags);

/// Whether a value of OpenStreetMap says that a thing is there: anything but "" and "no", of which
/// GeoJSON makes `false`, and Geofabrik "F" and 0.
[[nodiscard]] bool IsThere(std::string_view value);

/// Whether the tags of a way say that it lies in a tunnel, or on a bridge; never both.
[[nodiscard]] bool IsTunnel(const MapTags& tags);
[[nodiscard]] bool IsBridge(const MapTags& tags);

/// What the licence of OpenStreetMap asks for.
inline constexpr const char* kOpenStreetMapAttribution =
    "(c) OpenStreetMap contributors, ODbL 1.0 (https://www.openstreetmap.org/copyright)";

/// What a height of a source must be, and whether it is.
inline constexpr const char* kHeightRule = "must have heights from -1000 to 10000 m";
[[nodiscard]] inline bool IsHeight(double height_m) {
  return height_m >= -1000.0 && height_m <= 10000.0;
}

struct MapNode {
  /// As in the source: longitude and latitude in degrees (WGS 84).
  Eigen::Vector2d geographic_deg = Eigen::Vector2d::Zero();
  /// In metres, east and north of the map's origin (MapProjection).
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();
  std::optional<double> height_m = std::nullopt;  ///< Where the source has it.
  /// Surveyed height of the outer above the inner rail, where the source has it.
  std::optional<double> cant_mm = std::nullopt;
  MapTags tags;
};

/// A stretch of one track between two of the nodes at which mappers divide tracks.
struct MapWay {
  std::int64_t id{};               ///< Id in the source, for messages.
  std::vector<std::size_t> nodes;  ///< At least two; no two neighbours are equal.
  MapTags tags;
  std::string place{};  ///< In its file, for messages: "way 7", "/features/3".
};

/// Appends a node, unless the way ends with it already, as sources sometimes repeat it.
inline void AppendNode(std::size_t node, MapWay& way) {
  if (way.nodes.empty() || way.nodes.back() != node) way.nodes.push_back(node);
}

/// Something beside or on tracks, such as a platform or a signal.
struct MapThing {
  std::vector<Eigen::Vector2d> geographic_deg;  ///< One point, or those of a line or an outline.
  std::vector<Eigen::Vector2d> places_m;        ///< As many, once the map is projected.
  MapTags tags;
};

/// The railway tracks of a map. Tracks meet where ways share a node.
struct RailMap {
  std::vector<MapNode> nodes;
  std::vector<MapWay> ways;
  std::vector<MapThing> things;
  std::string attribution;
  /// What was not taken as it stands in the file; their places are those of the file: "way 7".
  std::vector<Remark> remarks{};
};

}  // namespace railcast
